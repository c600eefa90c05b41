"""python -m modelgen."""

from modelgen.cli import main

if __name__ == "__main__":
    main()
