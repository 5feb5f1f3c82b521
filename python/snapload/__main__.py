"""The command ``snapload``, as ``python -m snapload`` and as the script that comes with the package."""

import sys

from . import _engine


def main() -> None:
    """Executes the command line, and ends with its exit status."""
    sys.exit(_engine.command(["snapload", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
