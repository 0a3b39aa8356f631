"""The subcommands of `haptoflow-training`: each module has `add_options(parser)` and `run(options)`."""
