"""The subcommands of `haptoflow-paper`: each module has `register(subparsers, summary)`."""
