"""Movies of scenes: artists show the snapshots, and files are complete."""

from contextlib import closing

import numpy as np
import pytest
from brute_force import settings
from imageio_ffmpeg import count_frames_and_secs, read_frames
from PIL import Image
from raw import build, typed
from schedules import COOLING, STEADY

from roughgas.show import style as movie
from roughgas.show.movies import MovieSubject, particles, picture, spin_scales, write
from roughgas.simulation.trajectory import Snapshot

SIDE = 12.0
SPIN, ANGLE = [[0.5], [-0.5], [0.0]], [0.0, np.pi / 2, 3.0]
POSITION = np.array([[3.0, 4.0], [6.0, 5.0], [11.5, 11.7]])
STILL = Snapshot(
    time=10.0,
    collisions=0.0,
    position=POSITION,
    unwrapped=POSITION,
    velocity=np.zeros((3, 2)),
    spin=np.array(SPIN),
    angle=np.array(ANGLE),
    E_trans=1.0,
    E_rot=1.0,
    R=0.5,
    floor=None,
    slide=None,
    walls=None,
)


def subject(kernel, box, beta=0.5, schedule=STEADY, **settings_changes):
    experiment = settings(kernel, 3, box) | {"schedule": schedule} | settings_changes
    return MovieSubject(kernel, typed(experiment), build(experiment, 0.9, beta), 7)


def shots(number=3, **changes):
    return [STILL._replace(time=10.0 + 0.1 * k, collisions=k, **changes) for k in range(number)]


def artists(movie_subject, frames, frame=0):
    """Return the axes of the particles, the disks, and the marks on them, at a frame."""
    figure, show = picture([(movie_subject, frames)])
    show(frame)
    above = figure.axes[0]
    disks, *lines = above.collections
    return above, disks, lines


def test_a_disk_has_the_colour_of_its_spin_and_a_mark_at_its_angle():
    _, disks, (marks,) = artists(subject("gas", [SIDE, SIDE]), shots())
    assert disks.get_offsets()[:2].tolist() == [[3.0, 4.0], [6.0, 5.0]]
    assert np.all(disks.get_widths() == 2.0)
    left, right, still = disks.get_facecolor()[:3, :3]
    assert left[2] > left[0] and right[0] > right[2] and np.ptp(still) < 0.02
    (start, tip), (_, second_tip) = marks.get_segments()[:2]
    assert start == pytest.approx([3.0, 4.0]) and tip == pytest.approx([3.9, 4.0])
    assert second_tip == pytest.approx([6.0, 5.9])


@pytest.mark.parametrize("top", [SIDE, "open"])
def test_the_nearest_spheres_are_drawn_last(top):
    """The line of sight in a bed is the second axis, in a gas the third, from above."""
    gas = subject("bed" if top == "open" else "spheres", [SIDE, SIDE, top])
    position = np.array([[3.0, 6.0, 6.0], [4.0, 5.0, 4.0], [5.0, 4.0, 8.0]])
    frames = shots(position=position, spin=np.eye(3), angle=None, floor=0.0)
    _, disks, *_ = artists(gas, frames)
    centres = disks.get_offsets()[:: len(particles.SPHERE_DISKS), 0]
    assert centres.tolist() == ([3.0, 4.0, 5.0] if top == "open" else [4.0, 3.0, 5.0])


def test_colours_are_relative_to_the_thermal_spin():
    frames = shots(E_trans=3.0, E_rot=3.0)
    frames[1] = frames[1]._replace(E_trans=12.0, E_rot=12.0)
    thermal = np.sqrt(2 * np.array([3.0, 12.0, 3.0]) / 0.5)
    cooling = subject("gas", [SIDE, SIDE], schedule=COOLING)
    assert spin_scales(cooling, frames) == pytest.approx(thermal)
    driven = np.sqrt(2 * np.full(3, 6.0) / 0.5)
    assert spin_scales(subject("sheared", [SIDE, SIDE]), frames) == pytest.approx(driven)


def test_a_gif_has_every_frame_and_loops(tmp_path):
    path = tmp_path / "new" / "gas.gif"
    frames = [
        shot._replace(position=shot.position + k * np.array([0.3, 0.1]))
        for k, shot in enumerate(shots(5))
    ]
    write(path, [(subject("gas", [SIDE, SIDE]), frames)], 20.0)
    with Image.open(path) as image:
        assert image.n_frames == 5 and image.info["loop"] == 0 and image.info["duration"] == 50
        assert image.width == 336 and 280 < image.height <= 420
        pixels = np.asarray(image.convert("RGB"))
    assert pixels.std() > 20
    assert path.stat().st_size < 100_000
    assert list(path.parent.iterdir()) == [path]


def test_an_mp4_has_every_frame(tmp_path):
    path = tmp_path / "gas.mp4"
    write(path, [(subject("gas", [SIDE, SIDE]), shots(5))], 25.0)
    with closing(read_frames(str(path))) as reader:
        metadata = next(reader)
    assert metadata["fps"] == 25.0 and metadata["size"][0] == 960 and metadata["codec"] == "h264"
    assert count_frames_and_secs(str(path))[0] == 5


def test_an_encoder_that_fails_leaves_nothing_and_says_why(tmp_path, monkeypatch):
    monkeypatch.setitem(movie.ENCODERS, ".gif", "-vcodec nonsense -f gif")
    path = tmp_path / "gas.gif"
    with pytest.raises(OSError, match=r"not encoded: .*nonsense") as failure:
        write(path, [(subject("gas", [SIDE, SIDE]), shots())], 20.0)
    assert "\n" not in str(failure.value) and failure.value.filename == str(path)
    assert list(tmp_path.iterdir()) == []
