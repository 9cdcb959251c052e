"""`rigctl model show`: what a model consists of.

NOT its job: the tables (`rigctl.model.describe`).
"""

from __future__ import annotations

from typing import Annotated

import typer

from rigctl.app.model.common import DEFAULT_FORMATS, FormatOption, ModelArgument, OutOption, finish


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("show")(show)


def show(
    model: ModelArgument,
    names: Annotated[
        bool, typer.Option("--names", help="Print the names of all quantities and group members too.")
    ] = False,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """What a model consists of: bodies, coupling tables, parameter groups; with --names all quantities."""
    from rigctl.model.describe import describe
    from rigctl.model.loading import read_model

    tables = None if names else ("bodies", "couplings", "groups")
    finish(describe(read_model(model)), out, formats, tables=tables, lines=None)
