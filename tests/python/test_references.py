"""The published tables are whole and short; the analytic solutions meet figures made apart."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kolk import references
from kolk.errors import KolkError


@pytest.mark.parametrize("name", references.names())
def test_tables_are_short_cited_and_ascending(name: str) -> None:
    record = references.load(name)
    assert 2 <= len(record.table) <= 60
    assert record.paper and record.title and record.kind in {"experiment", "simulation"}
    assert set(record.units) == {"time", *record.columns}
    assert np.all(np.diff(record.time) > 0.0)
    assert np.isfinite(record.table.to_numpy()).all()


def test_unknown_names_say_what_exists() -> None:
    with pytest.raises(KolkError, match="martin-moyce"):
        references.load("martin-moyse")
    with pytest.raises(KolkError, match="P1, P2"):
        references.load("spheric2-pressure").values()
    with pytest.raises(KolkError, match="no column 'P9'"):
        references.load("spheric2-pressure").values("P9")


def test_tables_hold_the_published_figures() -> None:
    band = references.load("lobovsky-sensor2-band").table
    assert band["median"].max() == pytest.approx(1.867, abs=0.005)
    assert (band["low"] <= band["median"]).all() and (band["median"] <= band["high"]).all()
    assert references.load("lobovsky-sensor1").peak() == (2.843, 2.45)
    assert references.load("spheric2-pressure").peak("P1") == (11240.0, 0.415)
    assert references.load("yeh-petroff-force").peak() == (33.1, 0.396)
    levels = references.load("spheric2-level")
    arrival = [levels.time[np.argmax(levels.values(h) > 0.02)] for h in ("H3", "H2", "H1")]
    assert arrival == sorted(arrival)


def test_a_table_cannot_be_spoilt() -> None:
    table = references.load("koshizuka-oka").table
    table["front"] = 0.0
    assert references.load("koshizuka-oka").values()[0] == 1.0


def test_taylor_green_solves_navier_stokes() -> None:
    nu, t, e = 0.01, 0.3, 1e-4
    points = np.random.default_rng(1).random((50, 2))

    def u(shift: tuple[float, float] = (0.0, 0.0), dt: float = 0.0) -> np.ndarray:
        return references.taylor_green(points + np.array(shift), t + dt, viscosity=nu)[0]

    def p(shift: tuple[float, float]) -> np.ndarray:
        return references.taylor_green(points + np.array(shift), t, viscosity=nu)[1]

    ux = (u((e, 0)) - u((-e, 0))) / (2 * e)
    uy = (u((0, e)) - u((0, -e))) / (2 * e)
    laplace = (u((e, 0)) + u((-e, 0)) + u((0, e)) + u((0, -e)) - 4 * u()) / e**2
    grad = np.stack([p((e, 0)) - p((-e, 0)), p((0, e)) - p((0, -e))], -1) / (2 * e)
    rate = (u(dt=e) - u(dt=-e)) / (2 * e)
    residual = rate + u()[:, :1] * ux + u()[:, 1:] * uy + grad - nu * laplace
    assert np.abs(residual).max() < 1e-4
    assert np.abs(ux[:, 0] + uy[:, 1]).max() < 1e-6
    # at Re 100 the velocity is down to 0.20615 at t = 2
    assert math.exp(2 * references.taylor_green_decay_rate(0.01)) == pytest.approx(0.2061529924)


def test_channel_flows_meet_the_figures_of_morris() -> None:
    # L = 1 mm, nu = 1e-6 m^2/s, force 2e-4 m/s^2, plate 1.25e-5 m/s, at t = 0.0225 s
    y = np.array([5e-5, 2e-4, 5e-4])
    got = references.poiseuille(y, 0.0225, width=1e-3, viscosity=1e-6, acceleration=2e-4)
    assert got == pytest.approx([1.458194803e-06, 3.731287526e-06, 4.465475014e-06], rel=1e-9)
    got = references.couette(y, 0.0225, width=1e-3, viscosity=1e-6, speed=1.25e-5)
    assert got == pytest.approx([8.474212419e-11, 2.030317849e-09, 2.302765682e-07], rel=1e-6)
    end = references.poiseuille(y, math.inf, width=1e-3, viscosity=1e-6, acceleration=2e-4)
    assert end[2] == pytest.approx(2.5e-5)


@pytest.mark.parametrize(
    ("reynolds", "rate", "omega"),
    [(50, -0.2966515375, 1.681767594), (500, -0.03652429805, 1.766225687)],
)
def test_standing_wave_finds_the_viscous_root(reynolds: float, rate: float, omega: float) -> None:
    viscosity = math.sqrt(9.81) / reynolds
    wave = references.standing_wave(
        wavelength=2.0, depth=1.0, amplitude=0.05, viscosity=viscosity, gravity=9.81
    )
    assert wave.damping / math.sqrt(9.81) == pytest.approx(rate, rel=1e-8)
    assert wave.frequency / math.sqrt(9.81) == pytest.approx(omega, rel=1e-8)


def test_standing_wave_starts_flat_with_the_energy_of_its_amplitude() -> None:
    wave = references.standing_wave(wavelength=2.0, depth=1.0, amplitude=0.05)
    x, y = np.meshgrid((np.arange(200) + 0.5) / 100, -(np.arange(200) + 0.5) / 200, indexing="ij")
    u = wave.velocity(np.stack([x, y], -1), 0.0)
    energy = 0.5 * (u**2).sum() * (1 / 100) * (1 / 200)
    assert energy == pytest.approx((0.1) ** 2 * 9.81 * 2.0 / 16, rel=1e-3)
    assert not wave.elevation(x[:, 0], 0.0).any()


def test_drops() -> None:
    drop = references.stretching_drop([0.0, 0.001, 0.0082])
    assert drop.x == pytest.approx([1.0, 0.9051358121, 0.4933977633], rel=1e-8)
    assert drop.centre_pressure == pytest.approx([5e6, 4806463.943, 1056356.547], rel=1e-7)
    assert drop.x * drop.y == pytest.approx(np.ones(3))
    swing = references.oscillating_drop(np.array([0.0, 1.0, 30.0]))
    assert swing.x == pytest.approx([1.0, 0.527351207, 0.5242417857], rel=1e-7)
    assert references.oscillating_drop_period() == pytest.approx(4.82734, rel=1e-5)


def test_shallow_water_dam_breaks() -> None:
    h, u = references.ritter(np.array([-5.0, 0.0, 50.0]), 1.0, depth=1.0, gravity=1.0)
    assert h == pytest.approx([1.0, 4 / 9, 0.0])
    assert u == pytest.approx([0.0, 2 / 3, 0.0])
    states = references.stoker_states(1.0, 0.1, gravity=1.0)
    assert states.depth == pytest.approx(0.3961748168)
    assert states.velocity == pytest.approx(0.7411516107)
    assert states.bore_speed == pytest.approx(0.9913928766)
    assert states.tail_speed == pytest.approx(0.1117274161)
    x = np.linspace(-3, 3, 60001)
    h, _ = references.stoker(x, 1.5, upstream=1.0, downstream=0.1, gravity=1.0)
    assert h.sum() * (x[1] - x[0]) == pytest.approx(3.0 + 0.3, rel=1e-3)
    with pytest.raises(KolkError, match="downstream"):
        references.stoker_states(0.1, 1.0)


def test_hydrostatic_pressure_ends_at_the_surface() -> None:
    got = references.hydrostatic_pressure([0.0, 0.5, 2.0], surface=1.0)
    assert got == pytest.approx([9810.0, 4905.0, 0.0])
