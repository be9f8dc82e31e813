"""The sentences of the pages that quote numbers; {name:format} stands for each.

A format is Python's for numbers; one that ends in () has the error in brackets, +() with a sign.
"""

QUOTES = {
    "docs/results.md": [
        "within {cooling_spheres_off:.3f} at all of {cooling_spheres_points:.0f} points, sheared "
        "ones Lun's formula within {sheared_spheres_off:.3f}.",
        "A bed lies above it by up to {vibrated_spheres_most_above:()}, averaged over collisions "
        "by {vibrated_spheres_collisional_off:.3f}.",
        "over contacts that stick and slide, within {vibrated_friction_off:.3f}, from R = "
        "{vibrated_friction_least:.2f} at μ = {vibrated_friction_least_mu:g} to the rough gas",
        "A cooling gas of N = 160 does within {cooling_friction_off:.3f} for μ ≥ "
        "{cooling_friction_strong_mu:g} where it settles.",
        "and one soon holds {runaway_share_percent:.0f} % of the spin energy; R → 1, at μ = 0.2 "
        "after some {runaway_time_100:.0f} collisions per particle for N = 100, after "
        "{runaway_time_10000:.0f} for 10 000.",
        "is within {drives_collisional_off:.3f} of the rate equations, for random kicks",
        "Averaged over time within {heated_off:.3f}, {rough_floor_off:.3f}, "
        "{rough_side_walls_off:.3f} and {shaken_walls_off:.3f}, beds above",
        "At r = 0.9 by at most {wave_triangle_at_r09:+()} for a triangle, {wave_sine_at_r09:+()} "
        "for a sine, {wave_reversed_sawtooth_at_r09:+()} for a reversed sawtooth; at r = 0.8 by "
        "{wave_triangle_at_r08:+()}, {wave_sine_at_r08:+()}, "
        "{wave_reversed_sawtooth_at_r08:+()}. Averaged over collisions, by "
        "{waves_collisional_off:.3f}.",
        "a cooling gas follows the theory of free cooling within {cooling_inertia_off:.3f}. A bed "
        "follows Lun's formula within {vibrated_inertia_off:.3f} for q of 0.05 to 0.3; it is "
        "{vibrated_rings_above:()} above for rings, and at q ≤ 0.02 perfectly rough disks have R = "
        "{vibrated_light_rough:.2f}:",
        "at most {boundaries_most_share_percent:.0f} % of the energy: below 0.3 %, R shifts by no "
        "more than {boundaries_shift_without_rotation:.3f}.",
        "and take energy out of them, up to {boundaries_most_taken_percent:.0f} %.",
    ],
}
