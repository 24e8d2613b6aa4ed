"""What pytest finds of bladecad by itself: the fixture `blade_check`."""
