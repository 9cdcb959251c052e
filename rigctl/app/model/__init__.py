"""`rigctl model …`: the command line of the model studies, a module per family of commands."""

from __future__ import annotations

from importlib import import_module

import typer

#: modules with a function `register(app)`, in the order of the help
_FAMILIES = (
    "show", "figures", "pairs", "locus", "modes", "maps", "sensitivity", "motion", "limit_cycle", "studies",
    "minimal",
)  # fmt: skip


def model_app() -> typer.Typer:
    """All model commands."""
    app = typer.Typer(
        name="model",
        help="Studies of brake models: eigenvalues, stability, sensitivity, squeal, design.\n\n"
        "MODEL is a brake file (configs/brakes/model.toml) or matrices made elsewhere (.npz, .mat, folder of "
        ".mtx). Quantities are named as in `rigctl model show MODEL --names`. With --out a study writes "
        "figures, tables and JSON.",
        no_args_is_help=True,
    )
    for family in _FAMILIES:
        import_module(f"rigctl.app.model.{family}").register(app)
    return app
