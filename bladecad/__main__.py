"""`python -m bladecad` is `bladecad`."""

from bladecad.cli import main

main()
