import sys

from haptoflow_training.cli import main

sys.exit(main())
