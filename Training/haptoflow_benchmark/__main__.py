import sys

from haptoflow_benchmark.cli import main

sys.exit(main())
