"""The frozen base of the settings and results of this package.

Job: one place for "immutable, unknown keys refused, no NaN".
NOT its job: reading configuration files (rigctl.config).
"""

from pydantic import BaseModel, ConfigDict


class FrozenModel(BaseModel):
    """Immutable pydantic model: unknown keys, NaN and infinity are refused."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
