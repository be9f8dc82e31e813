"""Event-driven simulation of gases of rough, inelastic disks and spheres."""

__version__ = "0.1.0"
