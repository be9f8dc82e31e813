"""Statements on what McNamara & Luding (1998) leave open, and expect of it."""

from roughgas.claims.beyond import drives, friction, inertia, materials, spheres, waves

STATEMENTS = (
    *spheres.STATEMENTS,
    *drives.STATEMENTS,
    *materials.STATEMENTS,
    *friction.STATEMENTS,
    *waves.STATEMENTS,
    *inertia.STATEMENTS,
)
