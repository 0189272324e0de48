"""``jointgen scene``: what a user types, and what becomes of files that are wrong."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.c.packages import compile_silently, have
from tests.scenes.packages import STRICT
from tests.spec.texts import PENDULUM, changed

from .runs import contents, finish, invoke, refused, snapshot, spawn
from .terminal import CTRL_C, Terminal

OUTPUT = '\n[output]\nquantities = ["phi", "phi_q"]\n'
HOSTILE = (
    'x]; system("rm")',
    "a*/ int y = 1; /*",
    "a`b|c",
    "%s%n",
    "\\\\",
    "#define phi 1",
    "</script>",
    "été 日本",
    "r",
    "t0",
)


@pytest.fixture(scope="session")
def pendulum(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("scene") / "pendulum.toml"
    path.write_text(PENDULUM + OUTPUT)
    return path


@pytest.fixture(scope="session")
def package(pendulum: Path) -> Path:
    """The package of the pendulum; tests copy it."""
    target = pendulum.parent / "package"
    code, out, err = finish(spawn("scene", pendulum, "-o", target, "--form", "conventional", PYTHONHASHSEED="1"))
    assert (code, err) == (0, ""), "a pipe stays silent"
    assert re.fullmatch(rf"{re.escape(str(target))}: 5 functions in \d+ files\n", out)
    return target


def test_two_hash_seeds_and_folders_give_the_same_bytes(pendulum: Path, package: Path, tmp_path: Path) -> None:
    arguments = ("scene", pendulum, "-o", tmp_path / "elsewhere/deeper", "--form", "conventional")
    assert finish(spawn(*arguments, PYTHONHASHSEED="4711"))[0] == 0
    assert contents(tmp_path / "elsewhere/deeper") == contents(package)
    for name, data in contents(package).items():
        assert str(pendulum.parent).encode() not in data, name


def test_the_files_of_a_scene(package: Path) -> None:
    assert sorted(contents(package)) == sorted(
        ["README.md", "manifest.json", "jg_real.h", "pendulum.c", "pendulum.h", "pendulum_example.c"]
        + [f"casadi/{name}" for name in ("external.c", "phi.casadi", "phi_q.casadi", "all.casadi")]
    )


def test_without_measure_the_readme_says_how_to_measure(package: Path) -> None:
    readme = (package / "README.md").read_text()
    assert "`jointgen scene FILE -o DIR --measure` adds what each step takes on your machine." in readme
    assert "| ns |" not in readme


@pytest.mark.skipif(not have("gcc"), reason="needs gcc")
def test_measure_adds_instructions_and_nanoseconds_to_the_readme_and_changes_nothing_else(
    pendulum: Path, package: Path, tmp_path: Path
) -> None:
    result = invoke("scene", pendulum, "-o", tmp_path / "package", "--form", "conventional", "--measure")
    assert (result.exit_code, result.stderr) == (0, "")
    measured, plain = contents(tmp_path / "package"), contents(package)
    assert {name for name in plain if measured[name] != plain[name]} == {"README.md"}
    readme = measured["README.md"].decode()
    head = [
        "step",
        "operations",
        "saved",
        *(["instructions", "saved"] if have("valgrind") else []),
        "ns",
        "saved",
        "spread",
    ]
    assert f"| {' | '.join(head)} |" in readme
    assert have("valgrind") or "Instructions are not told: there is no valgrind." in readme
    steps = [line.strip("| ").split(" | ") for line in readme.split("| ns |")[1].splitlines()[2:] if "|" in line]
    assert len(steps) == 3
    times, operations = [float(line[-3]) for line in steps], [int(line[1]) for line in steps]
    assert all(time > 0 for time in times)
    assert operations == sorted(operations, reverse=True)
    if have("valgrind"):
        instructions = [int(line[3]) for line in steps]
        assert all(count > number for count, number in zip(instructions, operations, strict=True))
    assert re.search(r"Measured on .+ with .+ -O2", readme)


MISTAKES = {
    "a missing file": ("missing.toml", None, "missing.toml: cannot be read (No such file or directory)"),
    "a folder": (".", None, "is no kind of file that can be read; known: .toml (a scene file), .urdf (a URDF), .xml"),
    "a folder with an ending": ("folder.toml", None, "folder.toml: cannot be read (Is a directory)"),
    "an unknown ending": ("scene.yaml", b"a: 1", "scene.yaml: is no kind of file that can be read; known: .toml"),
    "no text": ("scene.toml", b"\xff\xfe", "scene.toml: is not UTF-8 text (byte 0)"),
    "no TOML": ("scene.toml", b"name = [", "scene.toml: "),
    "no XML": ("scene.urdf", b"<robot", "scene.urdf: "),
    "an empty file": ("scene.toml", b"", "scene.toml: "),
    "a key that there is not": ("scene.toml", b'nam = "x"\n', 'did you mean "name"?'),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_a_file_that_is_wrong_is_exit_code_2_and_leaves_the_folder_as_it_was(
    case: str, package: Path, tmp_path: Path
) -> None:
    name, content, words = MISTAKES[case]
    shutil.copytree(package, tmp_path / "package")
    (tmp_path / "folder.toml").mkdir()
    if content is not None:
        (tmp_path / name).write_bytes(content)
    before = snapshot(tmp_path)
    lines = refused(invoke("scene", tmp_path / name, "-o", tmp_path / "package"))
    assert any(words in line for line in lines), lines
    assert all(re.match(r".+: .+; .+", line) for line in lines), "place: what is wrong; remedy"
    assert snapshot(tmp_path) == before


def test_all_mistakes_of_a_scene_are_told_at_once(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(changed(("mass = 1.5", "mass = -1.5"), ('"pin"', '"pin"\ncolour = "red"')))
    lines = refused(invoke("scene", path, "-o", tmp_path / "package"))
    assert len(lines) == 2
    assert sorted(p.name for p in tmp_path.iterdir()) == ["scene.toml"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--form", "parametrik"), '--form: there is no "parametrik"; did you mean "parametric"?'),
        (("--real", "flaot"), '--real: there is no "flaot"; did you mean "float"?'),
        (("--form", "relative", "--measure"), "--measure: is not there in relative coordinates; leave it out"),
        (("--copies", "0"), "--copies"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, tuple) else "",
)
def test_an_option_that_is_wrong_is_told(
    arguments: tuple[str, ...], words: str, pendulum: Path, tmp_path: Path
) -> None:
    lines = refused(invoke("scene", pendulum, "-o", tmp_path / "package", *arguments))
    assert any(words in line for line in lines), lines
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_not_ours_is_left_alone(pendulum: Path, tmp_path: Path) -> None:
    (tmp_path / "precious.txt").write_text("mine")
    (line,) = refused(invoke("scene", pendulum, "-o", tmp_path))
    assert "is not empty and holds no manifest.json of jointgen" in line
    assert [path.name for path in tmp_path.iterdir()] == ["precious.txt"]


def test_a_folder_with_a_package_is_replaced_as_a_whole(pendulum: Path, package: Path, tmp_path: Path) -> None:
    target = tmp_path / "package"
    shutil.copytree(package, target)
    (target / "old.c").write_text("old")
    assert invoke("scene", pendulum, "-o", target, "--form", "conventional").exit_code == 0
    assert contents(target) == contents(package)
    assert [path.name for path in tmp_path.iterdir()] == ["package"]


@pytest.mark.parametrize("moment", ["0/5", "[1-4]/5"])
def test_ctrl_c_leaves_the_previous_package_or_the_new_one(
    moment: str, pendulum: Path, package: Path, tmp_path: Path
) -> None:
    target = tmp_path / "package"
    shutil.copytree(package, target)
    terminal = Terminal("scene", pendulum, "-o", target, "--form", "parametric")
    assert terminal.wait_for(rf"generating .*\b{moment}\b"), "a terminal shows how far it is"
    terminal.press(CTRL_C)
    code = terminal.finish()
    assert "Traceback" not in terminal.shown
    if contents(target) == contents(package):
        assert (code, "jointgen: interrupted; nothing was written" in terminal.shown) == (1, True)
    else:
        assert (code, " files" in terminal.shown) == (0, True)
    assert [path.name for path in tmp_path.iterdir()] == ["package"]


def hostile_scene() -> str:
    """Two bodies and joints for every pair of names."""
    lines = ['name = "hostile"\n']
    names = [name.replace("\\", "\\\\").replace('"', '\\"') for name in HOSTILE]
    lines += [f'[[body]]\nname = "{name}"\n' for name in names]
    for k, name in enumerate(names):
        first = f'"{names[k - 1]}"' if k else '"ground"'
        drive = "drive = { position = 0.0, speed = 1.0 }\n" if k == 0 else ""
        lines.append(
            f'[[joint]]\nname = "{name}"\ntype = "revolute"\nbodies = [{first}, "{name}"]\n'
            f"point = [0.0, 0.0, 0.0]\naxis = [0.0, 0.0, 1.0]\n{drive}"
        )
    lines.append(
        '[[joint]]\nname = "drive 0"\ntype = "ball"\nbodies = ["ground", "r"]\npoint = [0.0, 0.0, 0.0]\n'
        '[output]\nquantities = ["phi"]\n'
    )
    return "".join(lines)


@pytest.mark.skipif(not have("gcc"), reason="needs gcc")
def test_names_that_mean_harm_give_code_that_compiles_and_are_told_as_they_are(tmp_path: Path) -> None:
    path = tmp_path / "hostile.toml"
    path.write_text(hostile_scene())
    target = tmp_path / "package"
    result = invoke("scene", path, "-o", target, "--form", "conventional")
    assert (result.exit_code, result.stderr) == (0, ""), result.stderr
    for name in ("hostile.c", "casadi/external.c", "hostile_example.c"):
        compile_silently(["gcc", *STRICT, f"-I{target}", "-c", str(target / name), "-o", "/dev/null"])
        text = (target / name).read_text()
        assert text.isascii()
        assert "system" not in re.sub(r"\w*_system_\w*|_system\b", "", text)
    scene = json.loads((target / "manifest.json").read_text())["scene"]
    assert [body["name"] for body in scene["bodies"]] == list(HOSTILE)
    identifiers = [body["identifier"] for body in scene["bodies"]]
    assert len(set(identifiers)) == len(HOSTILE)
    assert all(re.fullmatch(r"[A-Za-z]\w*", identifier, re.ASCII) for identifier in identifiers)
    readme = (target / "README.md").read_text()
    assert "a\\`b\\|c" in readme
    assert not re.search(r"^\| a`", readme, re.MULTILINE)


CONSTANT = """name = "constant"
motion = "planar"
[[body]]
name = "wheel"
[[joint]]
name = "pin"
type = "revolute"
bodies = ["ground", "wheel"]
point = [0.0, 0.0, 0.0]
axis = [0.0, 0.0, 1.0]
[output]
quantities = ["phi", "phi_q", "phi_q_t_lambda_q", "phi_q_v"]
"""


@pytest.mark.skipif(not have("gcc"), reason="needs gcc")
@pytest.mark.parametrize("quantities", ["phi_q", "phi_q_t_lambda_q", "mass", "residual", "phi phi_q phi_q_t_lambda_q"])
def test_routines_without_arguments_or_entries_are_c_too(quantities: str, tmp_path: Path) -> None:
    """A wheel on a pin through its centre: the Jacobian is constant and its derivative empty."""
    text = CONSTANT[: CONSTANT.index("quantities")].replace(
        '"wheel"\n', '"wheel"\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n', 1
    )
    (tmp_path / "scene.toml").write_text(text + f"quantities = {json.dumps(quantities.split())}\n")
    target = tmp_path / "package"
    result = invoke("scene", tmp_path / "scene.toml", "-o", target)
    assert (result.exit_code, result.stderr) == (0, "")
    sources = [target / "constant.c", target / "constant_example.c", *target.glob("casadi/*.c")]
    for source in sources:
        compile_silently(["gcc", *STRICT, f"-I{target}", "-c", str(source), "-o", "/dev/null"])
    command = ["gcc", "-std=c99", *map(str, sources[:2]), "-lm", "-o", str(tmp_path / "example")]
    compile_silently(command)
    assert subprocess.run([tmp_path / "example"], check=True, capture_output=True).returncode == 0


def test_a_scene_may_not_have_the_name_of_the_header_that_all_share(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(CONSTANT.replace('"constant"', '"JG_Real"'))
    (line,) = refused(invoke("scene", tmp_path / "scene.toml", "-o", tmp_path / "package"))
    assert 'jg_real.h is a file that every package has; use another name, such as "JG_Real_scene"' in line


@pytest.mark.parametrize("name", ["example", "README", "manifest", "main"])
def test_a_scene_may_have_the_name_of_one_of_its_files(name: str, tmp_path: Path) -> None:
    text = CONSTANT.replace('"constant"', f'"{name}"').replace(', "phi_q", "phi_q_t_lambda_q", "phi_q_v"', "")
    (tmp_path / "scene.toml").write_text(text)
    assert invoke("scene", tmp_path / "scene.toml", "-o", tmp_path / "package").exit_code == 0
    files = contents(tmp_path / "package")
    assert len(files) == 8
    if have("gcc"):
        sources = [str(tmp_path / f"package/{file}.c") for file in (name, f"{name}_example")]
        compile_silently(["gcc", *STRICT, *sources, "-lm", "-o", str(tmp_path / "example")])
