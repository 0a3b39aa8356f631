"""The subcommands of `haptoflow-paper`: each module has `add_options(parser)` and `run(options)`."""
