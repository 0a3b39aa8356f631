import sys

from haptoflow_paper.cli import main

sys.exit(main())
