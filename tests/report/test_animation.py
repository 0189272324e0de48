"""The animation of a run holds its numbers, draws them where they belong, and lets no text out of its place."""

import base64
import hashlib
import json
import re
import shutil
import subprocess
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from codegen.report.animation import frames, page, page_data
from codegen.report.joint_glyphs import GLYPHS
from codegen.report.view import first_view
from codegen.spec.scene import SCENE_JOINTS

from .runs import engine, example, rotation, tumbling

HEADLESS = Path(__file__).with_name("headless.js")
VOID = {"meta", "input", "link", "img", "br"}


class Reader(HTMLParser):
    """Elements with their texts; an end without its start is an error."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open, self.elements = [], []
        self.feed(text)
        self.close()
        assert not self.open

    def handle_starttag(self, tag, attributes):
        element = (tag, dict(attributes), [])
        self.elements.append(element)
        if tag not in VOID:
            self.open.append(element)

    def handle_endtag(self, tag):
        assert self.open.pop()[0] == tag

    def handle_data(self, data):
        if self.open:
            self.open[-1][2].append(data)

    def handle_comment(self, data):
        raise AssertionError("a comment")

    def texts(self, tag, **attributes):
        found = (e for e in self.elements if e[0] == tag and attributes.items() <= e[1].items())
        return ["".join(words) for _, _, words in found]


def data_of(html: str) -> dict:
    (text,) = Reader(html).texts("script", id="data")
    return json.loads(text)


def script_of(html: str) -> str:
    return Reader(html).texts("script")[-1]


def columns_of(pose: list, count: int) -> np.ndarray:
    return np.stack([np.broadcast_to(column, count) for column in pose], axis=1)


def played(html: str, **settings) -> dict:
    """What the script does in a document that is none."""
    node = shutil.which("node")
    if node is None:
        pytest.skip("node is missing")
    given = json.dumps({"script": script_of(html), "data": data_of(html), **settings})
    done = subprocess.run([node, HEADLESS], input=given, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize("run", [engine, tumbling], ids=["engine", "tumbling"])
def test_poses_in_the_page_are_those_of_the_trajectory_to_the_digits_kept(run):
    scene, trajectory = run()
    data = data_of(page(scene, trajectory))
    count = len(trajectory.t)
    assert np.allclose(data["t"], trajectory.t, atol=1e-6 * np.ptp(trajectory.t), rtol=0)
    for k, body in enumerate(data["bodies"]):
        pose = columns_of(body["pose"], count)
        assert body["name"] == trajectory.bodies[k]
        assert np.allclose(pose[:, :3], trajectory.r[:, k], atol=1e-5 * data["radius"], rtol=0)
        sign = np.sign(np.sum(pose[:, 3:] * trajectory.q[:, k], axis=1))[:, None]
        assert np.allclose(sign * pose[:, 3:], trajectory.q[:, k], atol=1e-5, rtol=0)


def test_quaternions_do_not_change_sides_from_frame_to_frame():
    scene, trajectory = engine()
    flipped = replace(trajectory, q=trajectory.q * np.where(np.arange(len(trajectory.t)) % 3, 1, -1)[:, None, None])
    for body in data_of(page(scene, flipped))["bodies"]:
        q = columns_of(body["pose"], len(trajectory.t))[:, 3:]
        assert np.all(np.sum(q[1:] * q[:-1], axis=1) > 0)


def test_a_long_run_is_thinned_to_frames_of_its_own_and_says_so():
    scene, trajectory = engine(5001)
    html = page(scene, trajectory)
    kept = frames(trajectory)
    assert len(kept) == 600
    assert (kept[0], kept[-1]) == (0, 5000)
    assert "600 of 5001 output times are shown." in "".join(Reader(html).texts("p"))
    r = columns_of(data_of(html)["bodies"][1]["pose"], 600)[:, :3]
    assert np.allclose(r, trajectory.r[kept, 1], atol=1e-5, rtol=0)
    assert len(html) < 200_000


def test_turns_that_frames_cannot_show_are_told():
    scene, trajectory = engine(6)
    notes = "".join(Reader(page(scene, replace(trajectory, w=10 * trajectory.w))).texts("p"))
    assert "A body turns by up to 2.4 turns from one frame to the next." in notes  # 150 rad/s for 0.1 s
    assert "turns from one frame" not in "".join(Reader(page(*engine(60))).texts("p"))


def test_hostile_names_stay_text():
    names = ("</script><script>alert(1)</script>", '<!--<script>"&amp;\u2028')
    scene, trajectory = tumbling(5, names)
    html = page(replace(scene, name="</title><img src=x onerror=alert(1)>"), trajectory)
    reader = Reader(html)
    assert [body["name"] for body in data_of(html)["bodies"]] == list(names)
    assert reader.texts("title") == ["</title><img src=x onerror=alert(1)>: animation"]
    assert reader.texts("h1") == ["</title><img src=x onerror=alert(1)>"]
    assert len(reader.texts("script")) == 2
    assert not reader.texts("img")
    (text,) = reader.texts("script", id="data")
    assert not set("<>&") & set(text)
    offers = played(html)["offers"]
    assert any(names[0] in offer for offer in offers)


def test_the_page_refers_to_nothing_outside():
    html = page(*engine())
    for word in (
        "http:",
        "https:",
        "//www",
        "src=",
        "href=",
        "@import",
        "url(",
        "fetch(",
        "import(",
        "XMLHttp",
        "eval(",
    ):
        assert word not in html
    (policy,) = (e[1]["content"] for e in Reader(html).elements if e[1].get("http-equiv"))
    assert policy.startswith("default-src 'none'")


def test_the_policy_of_the_page_admits_its_own_script_only():
    html = page(*engine())
    digest = base64.b64encode(hashlib.sha256(script_of(html).encode()).digest()).decode()
    assert re.search(r"script-src '([^']*)'", html)[1] == f"sha256-{digest}"


def test_every_control_has_a_name():
    reader = Reader(page(*engine()))
    labelled = "".join(reader.texts("label"))
    for tag, attributes, words in reader.elements:
        if tag == "button":
            assert "".join(words).strip() or attributes["aria-label"]
        if tag == "input":
            assert "aria-label" in attributes or {"loop": "Loop", "names": "Names"}[attributes["id"]] in labelled
        if tag == "canvas":
            assert attributes["tabindex"] == "0"


def test_every_joint_type_has_a_glyph_or_is_a_dot():
    assert set(GLYPHS) == set(SCENE_JOINTS)
    assert [kind for kind, strokes in GLYPHS.items() if not strokes] == ["ball"]


def test_planar_mechanisms_are_seen_along_their_normal_and_gravity_points_down():
    right, up, out = first_view(example("in_line_engine"))
    assert np.allclose([right, up, out], np.eye(3))
    scene = replace(example("in_line_engine"), gravity=(0, 0, 0))
    assert np.allclose(first_view(scene), np.eye(3))
    spatial = example("bricard")
    view = first_view(spatial)
    assert np.allclose(view @ view.T, np.eye(3))
    assert np.linalg.det(view) == pytest.approx(1.0)
    down = view @ np.array(spatial.gravity, dtype=float)
    assert down[1] < 0
    assert down[0] == pytest.approx(0.0)


# --- the script, in node


def test_the_script_puts_points_of_bodies_where_numpy_puts_them():
    scene, trajectory = tumbling()
    html = page(scene, trajectory)
    data, result = data_of(html), played(html)
    for k, body in enumerate(data["bodies"]):
        turn = rotation(trajectory.q[:, k])
        for n, s in enumerate(body["points"]):
            truth = trajectory.r[:, k] + turn.apply(s)
            given = np.array([points[n] for points in result["points"][k]])
            assert np.allclose(given, truth, atol=1e-4 * data["radius"], rtol=0)
    points = {tuple(s) for body in data["bodies"] for s in body["points"]}
    ends = [(joint, side) for joint in data["joints"] for side in (0, 1) if joint["bodies"][side] >= 0]
    assert all(tuple(joint["points"][side]) in points for joint, side in ends)


def test_the_script_draws_glyphs_in_the_frames_of_their_joints():
    scene, trajectory = tumbling()
    html = page(scene, trajectory)
    data, result = data_of(html), played(html)
    for joint, strokes in zip(scene.joints, result["strokes"], strict=True):
        for stroke, given in zip(GLYPHS[joint.type], strokes, strict=True):
            marker = (joint.marker_i, joint.marker_j)[stroke.side]
            s, C = (np.array(x, dtype=float) for x in (marker.point, marker.axes))
            local = s + data["glyph"] * np.array(stroke.points) @ C.T
            name = joint.bodies[stroke.side]
            if name != "ground":
                k = trajectory.bodies.index(name)
                turn = rotation(trajectory.q[0, k])
                local = trajectory.r[0, k] + turn.apply(local)
            assert np.allclose(given, local, atol=1e-4 * data["radius"], rtol=0)


def test_the_script_finds_the_frame_of_a_time():
    scene, trajectory = tumbling()
    html = page(scene, trajectory)
    t = np.array(data_of(html)["t"])
    times = [t[0] - 1, *t, *(0.3 * t[:-1] + 0.7 * t[1:]), t[-1] + 1]
    found = played(html, times=times)["frames"]
    assert np.allclose(found, np.interp(times, t, np.arange(len(t))), atol=1e-9)


def test_a_view_that_is_turned_stays_a_rotation_and_upright():
    html = page(*tumbling())
    before, after = np.array(data_of(html)["view"]), np.array(played(html)["view"])
    assert np.allclose(after @ after.T, np.eye(3), atol=1e-4)
    assert abs(after[0] @ before[1]) < 1e-4, "right stays level"


def test_the_picture_shows_the_frame_of_the_slider():
    scene, trajectory = engine()
    html = page(scene, trajectory)
    result = played(html, presses=[["slider", "input", {"set": {"value": "17"}}]])
    data = data_of(html)
    middle, scale = np.array(data["centre"][:2]), 0.44 * 600 / data["radius"]
    drawn = [np.array(line["points"]) for line in result["lines"] if line["width"] == 4]
    assert len(drawn) == 5, "two ends of the crank, two of the rod, and the piston whose joints are in one point"
    for k in (0, 1):
        x, y = scale * (trajectory.r[17, k, :2] - middle)
        assert min(np.linalg.norm(line[0] - (400 + x, 300 - y)) for line in drawn) < 0.1
    assert result["time"] == f"t = {trajectory.t[17]:#.5g} s"
    assert result["button"] == "Play"


def test_a_slide_is_drawn_from_its_guide_to_what_slides():
    scene, trajectory = engine()
    html = page(scene, trajectory)
    result = played(html, presses=[["slider", "input", {"set": {"value": "17"}}]])
    data = data_of(html)
    (slide,) = (line["points"] for line in result["lines"] if line["width"] == 2.5)
    cylinder = next(joint for joint in scene.joints if joint.type == "translational")
    guide = [float(x) for x in cylinder.marker_i.point]
    for end, (x, y, _) in zip(slide, (guide, trajectory.r[17, 2]), strict=True):
        middle, scale = np.array(data["centre"][:2]), 0.44 * 600 / data["radius"]
        assert np.allclose(end, (400 + scale * (x - middle[0]), 300 - scale * (y - middle[1])), atol=0.1)


def test_a_trace_is_the_path_of_its_point():
    scene, trajectory = engine()
    html = page(scene, trajectory)
    data, offers = data_of(html), played(html)["offers"]
    assert offers[:3] == [f" {body}: centre of mass" for body in trajectory.bodies]
    pin = offers.index(" crank pin, on crank")
    middle, scale = np.array(data["centre"][:2]), 0.44 * 600 / data["radius"]
    paths = [np.array(line["points"]) for line in played(html, traces=[1, pin])["lines"][:2]]
    for path, truth in zip(paths, (trajectory.r[:, 1], 2 * trajectory.r[:, 0]), strict=True):
        x, y = (scale * (truth[:, :2] - middle)).T
        assert np.allclose(path, np.stack([400 + x, 300 - y], axis=1), atol=0.1)


@pytest.mark.parametrize("run", [engine, tumbling], ids=["engine", "tumbling"])
def test_all_controls_and_keys_work(run):
    keys = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "+", "-", "0"]
    drag = {"clientX": 5, "clientY": 7, "pointerId": 1, "buttons": 1}
    presses = [
        *([button, "click", {}] for button in ("home", "along-x", "along-y", "along-z", "nearer", "farther")),
        *(["picture", "keydown", {"key": key}] for key in keys),
        ["picture", "pointerdown", drag],
        ["picture", "pointermove", {**drag, "clientX": 50}],
        ["picture", "pointermove", {**drag, "buttons": 2}],
        ["picture", "pointerup", drag],
        ["picture", "wheel", {"deltaY": 100}],
        *([None, "keydown", {"key": key}] for key in (".", ".", ",")),
        ["names", "change", {"set": {"checked": True}}],
    ]
    scene, trajectory = run()
    result = played(page(scene, trajectory), presses=presses)
    assert result["time"] == f"t = {trajectory.t[1]:#.5g} s"
    assert set(trajectory.bodies) <= set(result["texts"])
    assert result["lines"]


def test_the_run_plays_at_its_own_speed_and_ends_or_begins_again():
    scene, trajectory = engine()
    html = page(scene, replace(trajectory, t=4 * trajectory.t))  # 2 s
    begun = played(html, plays=True, clocks=[1000, 1500])
    assert begun["button"] == "Pause"
    assert begun["time"] == "t = 0.50000 s"
    ended = played(html, plays=True, clocks=[0, 2500])
    assert (ended["button"], ended["time"]) == ("Play", "t = 2.0000 s")
    assert played(html, plays=True, loops=True, clocks=[0, 2500])["time"] == "t = 0.50000 s"


def test_a_run_of_one_time_is_a_page_too():
    scene, trajectory = engine(2)
    first = {n: getattr(trajectory, n)[:1] for n in ("t", "r", "q", "v", "w", "a", "al")}
    html = page(scene, replace(trajectory, **first))
    assert played(html)["lines"]
    assert page_data(scene, replace(trajectory, **first))["t"] == [0]
