"""The plant's file: shipped values load, nonsense is refused with a reason."""

import pytest
from plant_rig import CONFIGS, changed_settings, shipped_brake, shipped_mapping, shipped_settings
from pydantic import ValidationError

from rigctl.core.errors import ConfigError
from sim_hardware.plant import Plant, PlantSettings


def test_shipped_file_gives_the_values_of_the_paper():
    settings = shipped_settings()
    assert settings.drive.max_power_w == 84e3
    assert settings.thermal.ventilator_max_m3_h == 1000.0
    assert settings.friction.slope_s_m == 0.0576
    assert settings.pressure.max_pressure_bar >= 40.0


def test_every_value_of_the_shipped_file_has_unit_or_origin():
    for number, line in enumerate((CONFIGS / "plants" / "a_class.toml").read_text().splitlines(), 1):
        value, _, comment = line.partition("#")
        physical = "=" in value and not value.startswith(("name", "gain", "offset"))
        assert not physical or len(comment.strip()) >= 3, (
            f"line {number} says nothing about its value: {line}"
        )


@pytest.mark.parametrize(
    ("section", "key", "value"),
    [
        ("drive", "inertia_kg_m2", 0.0),
        ("pressure", "damping_ratio", 0.0),
        ("pressure", "max_pressure_bar", float("nan")),
        ("thermal", "disc_heat_share", 1.2),
        ("friction", "scatter_mu", -0.1),
        ("torque_chain", "frame_hz", 10.0),
        ("microphone", "full_scale_pa", "20 Pa"),
        ("background", "motor_lines_db", []),
    ],
)
def test_values_outside_their_bounds_are_refused(section, key, value):
    with pytest.raises(ValidationError) as caught:
        changed_settings(**{f"{section}__{key}": value})
    assert caught.value.errors()[0]["loc"][:2] == (section, key)


def test_unknown_keys_are_refused_everywhere():
    for section in ("drive", "radiation", "sensors"):
        mapping = shipped_mapping()
        mapping[section]["colour"] = 1.0
        with pytest.raises(ValidationError, match="colour"):
            PlantSettings.model_validate(mapping)


def test_pyrometer_range_must_be_a_range():
    with pytest.raises(ValidationError) as caught:
        changed_settings(pyrometer__range_from_degc=900.0)
    assert "range_from_degc below" in caught.value.errors()[0]["ctx"]["remedy"]


@pytest.mark.parametrize("freedom", ["disc.z", "disc.phi", "wheel.y"])
def test_radiating_surface_must_move_with_the_brake(freedom):
    settings = changed_settings(radiation__areas_m2={freedom: 0.01})
    with pytest.raises(ConfigError, match="areas_m2") as caught:
        Plant(settings, shipped_brake(), seed=1)
    assert "disc.y" in caught.value.remedy
