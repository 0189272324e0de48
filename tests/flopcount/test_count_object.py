"""The counts are the floating-point instructions of the object code that gcc makes at -O0 (SPEC S1.6).

Nothing is optimised there: one instruction an operation. A change of sign is an ``xor`` and not counted; a pair of
sine and cosine is a call of ``jg_sincos``. gcc takes one liberty, ``x + x`` for ``2.0 * x``: twos are threes here.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections import Counter
from pathlib import Path

import pytest

from codegen import build, output
from codegen.spec.request import Options

GENERATED = Path(__file__).resolve().parents[2] / "generated"
SOURCES = sorted(path.stem for path in (GENERATED / "c/src").glob("*.c"))
KIND = {
    "addsd": "add",
    "subsd": "add",
    "mulsd": "mul",
    "divsd": "div",
    "fma": "fma",
    "sqrtsd": "sqrt",
    "jg_sincos": "sincos",
    "sin": "sin",
    "cos": "cos",
    "atan2": "atan2",
}
HEADING = re.compile(r"^[0-9a-f]+ <(\w+)>:$", re.MULTILINE)
INSTRUCTION = re.compile(r"^\s+[0-9a-f]+:\s+(\w+)", re.MULTILINE)
CALL = re.compile(r"R_X86_64_(?:PLT32|PC32|GOTPCREL\w*)\s+(\w+)|\scall\w*\s+[0-9a-f]+ <(\w+)>$", re.MULTILINE)

pytestmark = pytest.mark.skipif(
    shutil.which("objdump") is None or shutil.which("gcc") is None, reason="needs gcc and objdump"
)


def disassembled(path: Path) -> dict[str, str]:
    """Function -> its disassembly with relocations."""
    run = subprocess.run(
        ["objdump", "-d", "-r", "--no-show-raw-insn", str(path)],
        capture_output=True,
        text=True,
        check=True,
    )
    if "x86-64" not in run.stdout:
        pytest.skip("the instructions are known for x86-64 only")
    pieces = HEADING.split(run.stdout)
    return dict(zip(pieces[1::2], pieces[2::2], strict=True))


def kinds_of(name: str, functions: dict[str, str]) -> Counter[str]:
    """Operations of a function and of the routines it calls."""
    text = functions[name]
    kinds = Counter(KIND[word] for word in INSTRUCTION.findall(text) if word in KIND)
    for relocated, local in CALL.findall(text):
        callee = relocated or local
        if callee in KIND:
            kinds[KIND[callee]] += 1
        elif callee.startswith("jg_") and callee in functions and callee != name and not callee.endswith("_sparsity"):
            kinds += kinds_of(callee, functions) if callee != "jg_scatter" else Counter()
    return kinds


def check(root: Path, stem: str, tmp_path: Path) -> int:
    """Compare every routine of a source with its object code; gives their number."""
    source, target = tmp_path / "routines.c", tmp_path / "routines.o"
    text = (root / f"c/src/{stem}.c").read_text()
    source.write_text(text.replace("JG_REAL(2.0)", "JG_REAL(3.0)").replace("JG_REAL(-2.0)", "JG_REAL(-3.0)"))
    flags = ["-std=c99", "-O0", f"-I{root / 'c/include'}"]
    subprocess.run(["gcc", *flags, "-c", str(source), "-o", str(target)], check=True)
    functions = disassembled(target)
    records = json.loads((root / "manifest.json").read_text())["functions"]
    chosen = [record for record in records if Path(record["source"]).stem == stem]
    for record in chosen:
        operations = {kind: n for kind, n in record["operations"].items() if n and kind not in ("neg", "total")}
        assert dict(kinds_of(record["symbol"], functions)) == operations, record["symbol"]
    return len(chosen)


@pytest.mark.parametrize("stem", SOURCES)
def test_counts_are_the_floating_point_instructions(stem: str, tmp_path: Path) -> None:
    assert check(GENERATED, stem, tmp_path) == 10


@pytest.mark.parametrize("joint", ["screw", "universal"])
def test_fused_multiply_adds_are_counted_as_they_are_called(joint: str, tmp_path: Path) -> None:
    output.replace(tmp_path / "package", build.generate(Options((joint,), outputs=("all",), fma=True)))
    for source in sorted((tmp_path / "package/c/src").glob("*.c")):
        assert check(tmp_path / "package", source.stem, tmp_path) == 2
        assert "jg_fma(" in source.read_text()
