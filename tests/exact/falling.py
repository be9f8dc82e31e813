"""When a particle meets a floor or a wall, in fifty digits."""

from decimal import Decimal

ZERO, NEVER = Decimal(0), Decimal("Infinity")


def exact_side(side):
    """A wall that is at rest or moves at constant velocity: there are no others here."""
    assert side.settings["temperature"] is None and side.settings["amplitude"] == 0.0
    return side._replace(inwards=Decimal(side.inwards), at=Decimal(side.at))


def fall_or_drift(gap, speed, weight):
    """The same with gravity of any sign, or none."""
    if weight > 0:
        return fall(gap, speed, weight)
    square = speed * speed + 2 * weight * gap
    if speed >= 0 or square < 0:
        return NEVER
    return 2 * max(gap, ZERO) / (square.sqrt() - speed)


def fall(gap, speed, gravity):
    """First time at which gap + speed t - gravity t^2/2 vanishes, from above."""
    if gap <= 0 and speed < 0:
        return ZERO
    return (speed + (speed * speed + 2 * gravity * max(gap, ZERO)).sqrt()) / gravity
