"""The pictures of a run: its plot and, on request, the page that plays it."""

from __future__ import annotations

from codegen.report.animation import page
from codegen.report.motion_plot import plot
from codegen.simulate.trajectory import Trajectory
from codegen.spec.scene import Scene


def run_pictures(scene: Scene, trajectory: Trajectory, animation: bool) -> dict[str, bytes]:
    """Draw a run.

    Args:
        scene: the mechanism.
        trajectory: its motion.
        animation: whether the page is wanted too.

    Returns:
        Path below the folder of the run -> content.
    """
    pictures = {"plot.svg": plot(trajectory, scene.name, scene)}
    pictures |= {"animation.html": page(scene, trajectory)} if animation else {}
    return {path: text.encode() for path, text in pictures.items()}
