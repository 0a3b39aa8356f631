"""The subcommands of `haptoflow-benchmark`: each module has `register(subparsers, summary)`."""
