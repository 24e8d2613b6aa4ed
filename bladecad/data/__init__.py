"""What was measured: sections, readers and writers by suffix, synthetic blades with known answers."""
