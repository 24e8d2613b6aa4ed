"""The command line: it parses, prints and exits; everything else is done by the floors below.

    app      the commands
    options  what can be asked for, once for all commands
    guard    exceptions become one line and an exit code
    console  progress on a terminal
    summary  a report as lines of text

Nothing heavy is imported before a command runs, so that `--help` answers at once.
"""

from bladecad.cli.app import app, main

__all__ = ["app", "main"]
