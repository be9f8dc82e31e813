"""Common types for walls that stand still in some stages and move in others.

The kernel is compiled for the types in a scene, and the types of a wall that never moves are
simpler. A wall that moves in any stage therefore has the types of its motion in all stages, with
amplitude 0 in stages where it stands still. Other scenes do not change.
"""

from collections.abc import Sequence
from typing import Any

from roughgas.effects.motions import Motion, PiecewiseLinear
from roughgas.effects.walls import MovingWall, ThermalWall, Wall
from roughgas.scene import Scene, walls_of


def with_common_wall_types(scenes: Sequence[Scene]) -> list[Scene]:
    """Return the scenes of a run; walls at rest get the types of their motion in another scene."""
    names = {name for scene in scenes for name in walls_of(scene.effects)}
    for name in sorted(names):
        walls = [getattr(scene.effects, name) for scene in scenes]
        moving = [wall for wall in walls if wall is not None and _ever_moves(wall)]
        moving.sort(key=lambda wall: wall.motion is None and wall.sliding is None)
        if moving:
            scenes = [
                _with_wall(scene, name, _with_types_of(wall, moving[0]))
                for scene, wall in zip(scenes, walls, strict=True)
            ]
    return list(scenes)


def _ever_moves(wall: Wall) -> bool:
    """Return whether a wall moves at some time: at constant velocity, shaken or sliding."""
    shaken = [motion for motion in (wall.motion, wall.sliding) if motion is not None]
    return wall.velocity != 0.0 or any(motion.amplitude > 0.0 for motion in shaken)


def _with_wall(scene: Scene, name: str, wall: Wall | None) -> Scene:
    """Return the scene with the wall effect `name` replaced."""
    if wall is getattr(scene.effects, name):
        return scene
    changes: dict[str, Any] = {name: wall}
    return scene._replace(effects=scene.effects._replace(**changes))


def _with_types_of(wall: Wall | None, moving: Wall) -> Wall | None:
    """Return `wall`; if it stands still, with the types of `moving`, the same wall in motion."""
    if wall is None or isinstance(wall, ThermalWall) or isinstance(moving, ThermalWall):
        return wall
    if _ever_moves(wall) or _wall_types(wall) == _wall_types(moving):
        return wall
    retyped = MovingWall(*wall) if type(wall) is Wall else wall
    return retyped._replace(
        motion=_resting_motion(moving.motion), sliding=_resting_motion(moving.sliding)
    )


def _wall_types(wall: Wall) -> tuple[type, ...]:
    """Return the types that the kernel is compiled for: of a wall and of its motions."""
    return type(wall), type(wall.motion), type(wall.sliding)


def _resting_motion(motion: Motion | None) -> Motion | None:
    """Return a motion of the same type with amplitude 0; None without a motion."""
    if isinstance(motion, PiecewiseLinear):
        zeros = (0.0,) * len(motion.shares)
        return motion._replace(amplitude=0.0, levels=zeros, speeds=zeros)
    return None if motion is None else motion._replace(amplitude=0.0)
