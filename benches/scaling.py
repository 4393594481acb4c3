"""How a step's cost grows with the particles, and how it is shared among threads.

    python benches/scaling.py                    # 10 000 to a million particles, minutes
    python benches/scaling.py --most 10000000    # 3 GiB and ten minutes more
    python benches/scaling.py --threads-only

Prints Markdown: nanoseconds per particle-step by phase and bytes per particle over the number of
particles; then, by phase, the gain of every core over one thread, the share of the machine's time
that is used, and what the parts that do not gain would leave on 16 and 64 cores (Amdahl's law,
phase by phase: an estimate on paper).
"""

from __future__ import annotations

import argparse
import math
import os
import time

from kolk import Simulation
from kolk.bench.settled import FLOWS, SETTLE, scene

PHASES = ("forces", "continuity", "walls", "integrate", "sort")


def measure(
    particles: int, threads: int, seconds: float
) -> tuple[Simulation, dict[str, float], float, int]:
    """Seconds by phase, the share of the threads' time used, and the steps of a settled flow."""
    sim = Simulation(scene(FLOWS[0], particles), precision="mixed", threads=threads)
    sim.advance(1e3, max_steps=SETTLE)
    before = {k: v["seconds"] for k, v in sim.timings.items()}
    wall, used, steps = time.perf_counter(), time.process_time(), 0
    while time.perf_counter() - wall < seconds or steps < 3:
        sim.advance(1e3, max_steps=1)
        steps += 1
    wall, used = time.perf_counter() - wall, time.process_time() - used
    spent = {k: v["seconds"] - before.get(k, 0.0) for k, v in sim.timings.items()}
    return sim, {**spent, "step": wall}, used / wall / threads, steps


def curve(most: int, threads: int) -> None:
    """The table over the number of particles."""
    print(
        "\n| fluid | wall | ns per particle-step | "
        + " | ".join(PHASES)
        + " | other | bytes a particle |"
    )
    print("|" + "---|" * (len(PHASES) + 5))
    for half_decades in range(round(2 * math.log10(most / 10_000)) + 1):
        particles = round(10_000 * 10 ** (half_decades / 2))
        sim, spent, _, steps = measure(particles, threads, 6.0)
        fluid, wall = sim.particles["fluid"], sim.particles["wall"]
        per = {k: v / steps / fluid * 1e9 for k, v in spent.items()}
        other = per["step"] - sum(per.get(p, 0.0) for p in PHASES)
        size = sum(sim.memory.values()) / (fluid + wall)
        row = [f"{per.get(p, 0.0):.0f}" for p in PHASES]
        print(
            f"| {fluid:,} | {wall:,} | {per['step']:.0f} | {' | '.join(row)} "
            f"| {other:.0f} | {size:.0f} |",
            flush=True,
        )


def shares(threads: int) -> None:
    """The table over threads, at 200 000 particles."""
    _, one, _, steps_one = measure(200_000, 1, 8.0)
    _, all_, busy, steps_all = measure(200_000, threads, 8.0)
    one = {k: v / steps_one for k, v in one.items()}
    all_ = {k: v / steps_all for k, v in all_.items()}
    print(
        f"\n{threads} threads, 200 000 particles: {100 * busy:.0f} % of the cores' time is used.\n"
    )
    print("| phase | share of a step on 1 thread | gain | serial share |")
    print("|---|---|---|---|")
    left = {16: 0.0, 64: 0.0}
    for phase in PHASES:
        gain = one[phase] / all_[phase]
        # Amdahl: gain = 1 / (s + (1 - s)/n).
        serial = min(1.0, max(0.0, (threads / gain - 1.0) / (threads - 1.0)))
        share = one[phase] / one["step"]
        print(f"| {phase} | {100 * share:.0f} % | {gain:.2f} | {100 * serial:.1f} % |")
        for cores in left:
            left[cores] += share * (serial + (1.0 - serial) / cores)
    rest = 1.0 - sum(one[p] for p in PHASES) / one["step"]
    for cores, time_left in left.items():
        total = time_left + max(0.0, rest) / cores
        print(f"\nOn {cores} cores: {1.0 / total:.0f} times one thread, if memory keeps up.")


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--most", type=int, default=1_000_000, help="particles of the largest run")
    parser.add_argument("--threads", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--threads-only", action="store_true", help="leave out the curve")
    asked = parser.parse_args()
    if not asked.threads_only:
        curve(asked.most, asked.threads)
    if asked.threads > 1:
        shares(asked.threads)


if __name__ == "__main__":
    main()
