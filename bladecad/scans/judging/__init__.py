"""What the points say of the finished surface: support, systematic deviation, worst places."""
