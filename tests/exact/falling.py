"""Times at which a particle meets a floor or a wall, in fifty digits."""

from decimal import Decimal

ZERO, NEVER = Decimal(0), Decimal("Infinity")


def exact_side(side):
    """Return a wall at rest or at constant velocity with decimals in place of floats; no other kind
    is simulated here."""
    assert side.settings["temperature"] is None and side.settings["amplitude"] == 0.0
    return side._replace(inwards=Decimal(side.inwards), at=Decimal(side.at))


def fall_or_drift(gap, speed, weight):
    """Return the time of `fall` with gravity of any sign, or none."""
    if weight > 0:
        return fall(gap, speed, weight)
    square = speed * speed + 2 * weight * gap
    if speed >= 0 or square < 0:
        return NEVER
    return 2 * max(gap, ZERO) / (square.sqrt() - speed)


def fall(gap, speed, gravity):
    """Return the smallest time with gap + speed t - gravity t^2/2 = 0, from above."""
    if gap <= 0 and speed < 0:
        return ZERO
    return (speed + (speed * speed + 2 * gravity * max(gap, ZERO)).sqrt()) / gravity
