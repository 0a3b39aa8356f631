"""The subcommands of `haptoflow-benchmark`: each module has `add_options(parser)` and `run(options)`."""
