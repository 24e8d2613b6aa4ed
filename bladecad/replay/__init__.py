"""The paper, replayed: its figures on a known blade, and what each improvement buys."""
