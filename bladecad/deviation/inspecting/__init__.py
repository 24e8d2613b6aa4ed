"""What a scan says of its nominal: coverage, zones, worst places, verdict."""
