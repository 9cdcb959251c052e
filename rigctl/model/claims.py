"""The paper's claims of sections 4.3.3 and 4.3.4, tested on a brake, and on brakes scattered around it.

    for claim in evaluate(read_model(Path("configs/brakes/model.toml"))):
        print(claim.verdict, claim.text, claim.numbers)

Job: evaluate all claims, scatter, table, figure. NOT its job: the claims themselves (`claims_robustness`,
`claims_influence`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from rigctl.analysis.style import BLUE, GREEN, GREY, ORANGE, VERMILION
from rigctl.model.claims_evidence import VERDICTS, Claim, Evidence, Untestable, Verdict
from rigctl.model.claims_influence import INFLUENCE_CLAIMS
from rigctl.model.claims_robustness import ROBUSTNESS_CLAIMS
from rigctl.model.output import Study, Table
from rigctl.model.sensitivity_figures import ranking_figure
from rigctl.model.sensitivity_tables import column
from sim_hardware.brake_model.linear import LinearModel
from sim_hardware.brake_model.parametric import LinearBrake

Progress = Callable[[int], None]
Scattered = Mapping[str, list[Verdict]]

CLAIMS: Mapping[str, Callable[[Evidence], Claim]] = ROBUSTNESS_CLAIMS | INFLUENCE_CLAIMS
_COLOURS: dict[Verdict, str] = dict(zip(VERDICTS, (GREEN, ORANGE, VERMILION, GREY), strict=True))


def evaluate(model: LinearModel) -> tuple[Claim, ...]:
    """All claims on a model; those whose groups the model lacks "cannot be tested".

    Raises
    ------
    KeyError
        the model has no friction
    """
    evidence = Evidence.of(model)
    return tuple(_judge(key, function, evidence) for key, function in CLAIMS.items())


def scattered_brakes(model: LinearBrake, samples: int, spread: float, seed: int) -> list[LinearBrake]:
    """Brakes with every parameter of the file multiplied by 1 + spread u, u even on [-1, 1]; seeded."""
    random = np.random.default_rng(seed)
    parameters = {name: p.value for name, p in model.brake.spec.parameters.items()}
    factors = 1.0 + spread * random.uniform(-1.0, 1.0, (samples, len(parameters)))
    return [
        LinearBrake(
            model.brake.with_parameters(**dict(zip(parameters, row * list(parameters.values()), strict=True)))
        )
        for row in factors
    ]


def scattered_verdicts(
    model: LinearModel, samples: int, spread: float = 0.10, seed: int = 1, progress: Progress | None = None
) -> dict[str, list[Verdict]]:
    """Verdicts on scattered brakes: key of the claim -> one verdict for each sample.

    `progress` is called with the number of samples done after each.

    Raises
    ------
    ValueError
        the model is no brake file, whose parameters could be scattered
    """
    if not isinstance(model, LinearBrake):
        raise ValueError("only brake files can be scattered: matrices made elsewhere have no parameters")
    verdicts: dict[str, list[Verdict]] = {}
    for done, brake in enumerate(scattered_brakes(model, samples, spread, seed), start=1):
        for claim in evaluate(brake):
            verdicts.setdefault(claim.key, []).append(claim.verdict)
        if progress is not None:
            progress(done)
    return verdicts


def claims_study(
    model: LinearModel,
    *,
    samples: int = 0,
    spread: float = 0.10,
    seed: int = 1,
    progress: Progress | None = None,
) -> Study:
    """Test every claim; with `samples` also on that many scattered brakes.

    Raises
    ------
    KeyError, ValueError
        the model has no friction, or cannot be scattered
    """
    claims = evaluate(model)
    scattered = scattered_verdicts(model, samples, spread, seed, progress) if samples else {}
    facts: dict[str, Any] = {
        verdict.replace(" ", "_"): sum(claim.verdict == verdict for claim in claims) for verdict in VERDICTS
    }
    if samples:
        facts |= {"samples": samples, "spread_percent": 100.0 * spread, "seed": seed}
    facts["claims"] = {
        claim.key: {"verdict": claim.verdict, "numbers": dict(claim.numbers)} for claim in claims
    }
    drawn = {"scatter": lambda: _figure(claims, scattered, spread)} if samples else {}
    title = f"{model.name}: the paper's claims on sensitivity"
    return Study("claims", title, facts, (_verdicts(claims, scattered), _measures(claims)), drawn)


def _judge(key: str, function: Callable[[Evidence], Claim], evidence: Evidence) -> Claim:
    try:
        return function(evidence)
    except Untestable as reason:
        summary = (function.__doc__ or "").strip()
        return Claim(key, "4.3", summary, "", {}, "cannot be tested", f"{reason}.")


def _shares(claims: Sequence[Claim], scattered: Scattered, verdict: Verdict) -> list[float | None]:
    """Share of samples with a verdict, %; None for claims that were not tested on them."""
    found = [scattered.get(claim.key) for claim in claims]
    return [
        None if verdicts is None else 100.0 * verdicts.count(verdict) / len(verdicts) for verdicts in found
    ]


def _verdicts(claims: Sequence[Claim], scattered: Scattered) -> Table:
    columns = [
        column("section", "", [claim.section for claim in claims]),
        column("claim", "", [claim.text for claim in claims]),
        column("verdict", "", [claim.verdict for claim in claims]),
        column("remark", "", [claim.remark or None for claim in claims]),
    ]
    if scattered:
        columns.insert(3, column("holds_scattered", "%", _shares(claims, scattered, "holds")))
        columns.insert(4, column("in_part_scattered", "%", _shares(claims, scattered, "holds in part")))
    return Table("verdicts", "Verdicts", tuple(columns))


def _measures(claims: Sequence[Claim]) -> Table:
    return Table(
        "measures",
        "What was measured",
        (
            column("key", "", [claim.key for claim in claims]),
            column("measure", "", [claim.measure or None for claim in claims]),
            column("numbers", "", [_text(claim.numbers) or None for claim in claims]),
        ),
    )


def _text(numbers: Mapping[str, Any]) -> str:
    return "; ".join(
        f"{key.replace('_', ' ')} {value:.4g}"
        if isinstance(value, float)
        else f"{key.replace('_', ' ')} {value}"
        for key, value in numbers.items()
    )


def _figure(claims: Sequence[Claim], scattered: Scattered, spread: float) -> Figure:
    shown = [claim for claim in claims if claim.key in scattered]
    holds = np.array(_shares(shown, scattered, "holds"), dtype=float)
    part = holds + np.array(_shares(shown, scattered, "holds in part"), dtype=float)
    used: list[Verdict] = [
        verdict for verdict in VERDICTS if any(claim.verdict == verdict for claim in shown)
    ]
    return ranking_figure(
        f"Claims on brakes scattered by ±{100 * spread:g} %; colour: verdict on the brake itself",
        [claim.key.replace("_", " ") for claim in shown],
        ((holds, "holds  [%]"), (part, "holds at least in part  [%]")),
        [_COLOURS.get(claim.verdict, BLUE) for claim in shown],
        [(verdict, _COLOURS[verdict]) for verdict in used],
    )
