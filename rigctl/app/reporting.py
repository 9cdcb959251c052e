"""`rigctl report`: the report of a campaign, with the model's prediction drawn into the measured picture.

Job: bring together the frozen campaign, the prediction and `rigctl.analysis`. Not its job: figures.
"""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from rigctl.app.campaign_file import CampaignFile
from rigctl.app.compose import prediction_of
from rigctl.app.durations import duration_text


def make_report(
    folder: Path, console: Console, *, wall_s: float | None = None, rig_s: float | None = None
) -> None:
    """Build `report/` of a campaign and print what it says.

    Raises
    ------
    ConfigError
        The folder is no campaign.
    """
    from rigctl.analysis.prediction import Prediction
    from rigctl.analysis.report import build_report
    from rigctl.analysis.summary import in_words

    file = CampaignFile.load(folder)
    path = file.prediction_path(folder)
    prediction = None
    if path is not None:
        found = prediction_of(path)
        if found.onset_pressure_bar is not None and found.onset_frequency_hz:
            prediction = Prediction(found.onset_pressure_bar, found.onset_frequency_hz, found.brake)
    info = {
        "Campaign": file.name,
        "Program": file.program_name,
        "Rig": file.rig.name + (" (simulated)" if file.rig.simulated else ""),
        "Seed": str(file.seed),
        "Versions": ", ".join(f"{name} {number}" for name, number in file.versions.items()),
    }
    if wall_s and rig_s:
        info["Duration"] = (
            f"{duration_text(rig_s)} of rig time in {wall_s:.1f} s ({rig_s / wall_s:.0f}× real time)"
        )
    result = build_report(folder, prediction=prediction, info=info)
    for sentence in in_words(result.summary):
        console.print(sentence, highlight=False)
    console.print(f"Report: {result.path}", highlight=False)
