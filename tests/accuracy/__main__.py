"""`python -m tests.accuracy [CASE ...]`: runs the study of kolk's choices, writes `docs/accuracy`.

About half an hour on two quiet cores; `--full` takes finer ladders, and hours.
"""

from __future__ import annotations

import argparse
import sys

from kolk.study.study import accuracy

from .choices import SUBJECTS
from .page import FOLDER, draw, keep, page


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.accuracy", description=__doc__)
    parser.add_argument("case", nargs="*", help="cases to study; all if none is named")
    parser.add_argument("--full", action="store_true", help="finer ladders")
    parser.add_argument("--page", action="store_true", help="only write the page")
    parser.add_argument("--threads", type=int, default=0, help="0: every core")
    chosen = parser.parse_args()
    names = [subject.case for subject in SUBJECTS]
    if unknown := set(chosen.case) - set(names):
        parser.error(f"no case is called {', '.join(sorted(unknown))}: {', '.join(names)}")
    for subject in SUBJECTS:
        if chosen.page or (chosen.case and subject.case not in chosen.case):
            continue
        print(subject.case, flush=True)
        study = accuracy(
            subject.scene,
            subject.full if chosen.full else subject.spacings,
            vary=subject.alternatives,
            quantity=subject.quantity,
            threads=chosen.threads,
            out=f"studies/defaults-{subject.case}",
        )
        print("\n".join(study.sentences), flush=True)
        keep(study, subject.case)
    draw()
    (FOLDER / "README.md").write_text(page(), encoding="utf-8")
    print(f"wrote {FOLDER / 'README.md'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
