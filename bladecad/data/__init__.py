"""What was measured: sections, readers and writers, synthetic blades with known answers."""
