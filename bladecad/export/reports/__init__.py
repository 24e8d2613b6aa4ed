"""What a blade has to say of itself, in words and numbers."""
