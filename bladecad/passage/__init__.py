"""The blade in its row: end walls, tip gap, and the periodic flow domain of one blade."""
