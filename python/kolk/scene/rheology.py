"""How a liquid resists: the table of its viscosity."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from kolk.errors import Problem, SceneError

from .base import Model, NotNegative, Positive, Real


class HerschelBulkley(Model):
    """A liquid with yield stress: ``tau = tau_y + K shear_rate^n``; mud, paste, fresh concrete."""

    yield_stress: NotNegative = Field(default=0.0, description="tau_y, Pa")
    consistency: Positive = Field(description="K, Pa s^n")
    index: Annotated[Real, Field(gt=0, le=3)] = Field(
        default=1.0, description="n: 1 is Bingham's liquid, less thins under shear"
    )
    max_viscosity: Positive | None = Field(
        default=None,
        description="Pa s, with which a plug creeps; if absent the largest that costs no time",
    )


class Viscosity(Model):
    """Artificial viscosity, that of the liquid (laminar or Herschel-Bulkley), and turbulence."""

    artificial: NotNegative | None = Field(
        default=None, description="Monaghan's alpha, 0.01 to 0.1"
    )
    beta: NotNegative = Field(default=0.0, description="Monaghan's beta: only for shocks")
    laminar: Positive | None = Field(default=None, description="kinematic viscosity, m^2/s")
    herschel_bulkley: HerschelBulkley | None = Field(
        default=None, description="a liquid with yield stress, instead of laminar viscosity"
    )
    turbulence: Annotated[Real, Field(gt=0, le=0.5)] | None = Field(
        default=None, description="Smagorinsky's constant of the eddies below the spacing, 0.12"
    )

    @model_validator(mode="after")
    def _something(self) -> Viscosity:
        parts = ("artificial", "laminar", "herschel_bulkley", "turbulence")
        if all(getattr(self, part) is None for part in parts):
            raise _wrong(f"is empty: give {', '.join(parts)}, or leave it out for none")
        for other in ("laminar", "turbulence"):
            if self.herschel_bulkley is not None and getattr(self, other) is not None:
                raise _wrong(f"found 'herschel_bulkley' beside '{other}': give one of them")
        return self


def _wrong(message: str) -> SceneError:
    return SceneError(problems=[Problem((), message)])
