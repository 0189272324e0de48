"""``python -m codegen``: the same as the ``jointgen`` command."""

from codegen.cli import main

if __name__ == "__main__":
    main()
