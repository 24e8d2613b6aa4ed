"""The scan laid onto its nominal, and what that absorbed."""
