"""Frames of several instants stored by the kernel, against frames of single instants."""

import numpy as np
import pytest
from brute_force import snapshot
from recorded import NAMES, Recording, bits, recorded

from roughgas.kernel.state import EXPONENT
from roughgas.observables.frames import PARTICLE_FIELDS, FrameSeries
from roughgas.simulation.frames import frames_of, present_raw_frame

INSTANTS = 30


def frame_of(gas, system):
    """The frame of the present instant."""
    return frames_of(gas, present_raw_frame(gas.state), system).frame(0)


def folded(shot, gas, time):
    """Positions and velocities of a snapshot, folded into the box."""
    shear, box = gas.scene.effects.shear, gas.scene.box
    for x, v in zip(shot.position, shot.velocity, strict=True):
        for axis, length in reversed([*enumerate(box)]):
            while length is not None and not 0.0 <= x[axis] < length:
                above = 1 if x[axis] > 0.0 else -1
                x[axis] -= above * length
                if shear is not None and axis == 1:
                    x[0] -= above * (shear.velocity * time % box[0])
                    v[0] -= above * shear.velocity
    return shot.position, shot.velocity


@pytest.mark.parametrize("name", NAMES)
def test_frames_have_the_bits_of_frames_one_by_one(name):
    """Of a gas observed after each call of the kernel, and of a gas whose frames a call stores."""
    single_calls, long_call = Recording(name), Recording(name)
    frames = frames_of(long_call.gas, raw := long_call.advance(INSTANTS), long_call.system)
    assert frames.instants == INSTANTS
    for number in range(INSTANTS):
        single_calls.advance(1)
        frame_of_call, single_frame = (
            frames.frame(number),
            frame_of(single_calls.gas, single_calls.system),
        )
        for field, value in single_frame._asdict().items():
            value_of_call = getattr(frame_of_call, field)
            assert type(value_of_call) is type(value), field
            if field not in ("system", "rates"):
                assert bits(value_of_call) == bits(value), field
    orders = {label.tobytes() for label in raw.label}
    assert ("in cells" in name) == (len(orders) > 1), "many particles are sorted anew"
    exponents = set(raw.counts[:, EXPONENT])
    assert long_call.system.cooling == (len(exponents) > 1), "a cooling gas is rescaled"


@pytest.mark.parametrize("name", NAMES)
def test_a_frame_has_the_particles_of_the_state_in_the_order_of_the_start(name):
    recording = Recording(name)
    recording.advance(INSTANTS)
    gas, state = recording.gas, recording.gas.state
    frame, shot = frame_of(gas, recording.system), snapshot(state, gas.scene)
    scale = 1.0 / frame.speed_unit * 2.0 ** int(state.counts[EXPONENT])
    spin, (position, velocity) = shot.spin, folded(shot, gas, frame.time)
    apart = np.abs(frame.position - position)
    for axis, length in enumerate(gas.scene.box):
        apart[:, axis] = np.minimum(apart[:, axis], (length or np.inf) - apart[:, axis])
    assert apart.max() < 1e-9
    assert frame.velocity == pytest.approx(scale * velocity, abs=1e-9)
    assert frame.spin == pytest.approx(scale * spin, abs=1e-9)
    if recording.system.cooling:
        energy = 0.5 * np.mean(frame.mass[:, None] * frame.velocity**2)
        assert energy == pytest.approx(1.0)


@pytest.mark.parametrize("name", NAMES)
def test_quantities_of_frames_are_those_of_each_frame(name):
    frames = recorded(name, INSTANTS)
    for name in ("energy", "thermal_velocity", "thermal_spin"):
        values = [getattr(frames.frame(number), name) for number in range(INSTANTS)]
        assert bits(getattr(frames, name)) == bits(np.array(values)), name


@pytest.mark.parametrize("name", NAMES)
def test_frames_of_species_and_joined_frames_are_those_of_each_instant(name):
    frames = recorded(name, INSTANTS)
    rates = {"work": np.arange(INSTANTS) / 7.0}
    frames = frames._replace(rates=rates)
    single_frames = [frames.frame(number) for number in range(INSTANTS)]
    assert single_frames[3].rates == {"work": 3 / 7}
    pairs = {"all": (FrameSeries.of(single_frames), frames)}
    if frames.species_of is not None:
        species_frames = frames.by_species()
        assert (
            len(species_frames) == 2
            and sum(frames_of_kind.system.particles for frames_of_kind in species_frames) > 70
        )
        for kind, frames_of_kind in enumerate(species_frames):
            pairs[kind] = (
                FrameSeries.of([frame.only(kind) for frame in single_frames]),
                frames_of_kind,
            )
    for joined_frames, kept_frames in pairs.values():
        assert (
            joined_frames.system == kept_frames.system
            and joined_frames.rates.keys() == kept_frames.rates.keys()
        )
        for field in PARTICLE_FIELDS:
            values = getattr(joined_frames, field), getattr(kept_frames, field)
            assert bits(values[0]) == bits(values[1]), field
            assert values[1] is None or values[1].flags.c_contiguous, "sums keep their order"
