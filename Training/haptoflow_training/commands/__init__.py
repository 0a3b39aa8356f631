"""The subcommands of `haptoflow-training`: each module has `register(subparsers, summary)`."""
