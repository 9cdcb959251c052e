"""`rigctl model …`: the command line of the model studies, a module per family of commands."""
