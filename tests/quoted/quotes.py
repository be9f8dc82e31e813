"""The sentences of the pages that quote numbers; {name:format} stands for each.

A format is Python's for numbers; one that ends in () has the error in brackets, +() with a sign.
"""

QUOTES = {
    "README.md": [
        "for r ≥ 0.8 within {vibrated_collisional_off:.3f} in the bed, "
        "{sheared_collisional_off:.3f} in the sheared gas.",
        "in the bed by up to {vibrated_most_above:.3f}.",
        "R is off by up to {rough_walls_off:.1f}.",
        "within {cooling_off_percent:.1f} % for r ≥ 0.8 (160 disks, packing 0.05), and depends "
        "strongly on r: at β = −0.8, R is {cooling_at_r099:.2f} at r = 0.99 and "
        "{cooling_at_r08:.2f} at r = 0.8.",
        "Of the {claims_statements} statements in the paper that can be tested, {claims_hold} "
        "hold, {claims_qualified} hold with a qualification, and {claims_fail} fail",
    ],
    "docs/results.md": [
        "at r ≥ 0.8 within {vibrated_collisional_off:.3f} in the bed, "
        "{sheared_collisional_off:.3f} in the sheared gas.",
        "in the vibrated bed by at most {vibrated_most_above:.3f} (r = {vibrated_most_at_r}, β = "
        "{vibrated_most_at_beta}), for |β| ≤ 0.5 on average by {vibrated_mean_at_r099:.3f}, "
        "{vibrated_mean_at_r09:.3f} and {vibrated_mean_at_r08:.3f} at r = 0.99, 0.9 and 0.8; in "
        "the sheared gas by at most {sheared_most_above:.3f}.",
        "R is off by up to {rough_walls_off:.1f}, and above 1/2 for smooth particles",
        "Walls of the particles' own material change R by {particle_walls_shift:.3f} at most, "
        "smooth ones by {smooth_walls_shift:.3f}.",
        "within {cooling_off_percent:.1f} % at every point with r ≥ 0.8 (N = 160, packing 0.05), "
        "and depends on r strongly: at β = −0.8, R is {cooling_at_r099:.2f} at r = 0.99 and "
        "{cooling_at_r08:.2f} at r = 0.8.",
        "R is up to {vibrated_most_above_at_r06:.3f} above Lun's formula in the bed, "
        "{sheared_most_above_at_r06:.3f} in the sheared gas, and up to "
        "{cooling_below_percent_at_r06:.0f} % below the theory of free cooling.",
        "The pipeline judges {claims_statements} statements of the paper in "
        "`results/paper/claims.md`: {claims_hold} hold, {claims_qualified} hold with a "
        "qualification (how closely Lun's formula and the theory of free cooling are followed, and "
        "how little r matters), "
        "and {claims_fail} fail.",
        "judges {open_questions_statements} statements in `results/paper/open_questions.md`, of "
        "which {open_questions_fail} fail: two on weak friction, two on rough walls that slide, "
        "and Lun's formula in a bed of",
        "within {cooling_spheres_off:.3f} at all of {cooling_spheres_points:.0f} points, sheared "
        "ones Lun's formula within {sheared_spheres_off:.3f}.",
        "A bed lies above it by up to {vibrated_spheres_most_above:()}, averaged over collisions "
        "by {vibrated_spheres_collisional_off:.3f}.",
        "over contacts that stick and slide, within {vibrated_friction_off:.3f}, from R = "
        "{vibrated_friction_least:.2f} at μ = {vibrated_friction_least_mu:g} to the rough gas",
        "A cooling gas of N = 160 does within {cooling_friction_off:.3f} for μ ≥ "
        "{cooling_friction_strong_mu:g} where it settles.",
        "and soon hold {runaway_share_percent:.0f} % of it; R → 1, at μ = 0.2 after some "
        "{runaway_time_100:.0f} collisions per particle for N = 100, after "
        "{runaway_time_10000:.0f} for 10 000.",
        "is within {drives_collisional_off:.3f} of the rate equations for random kicks",
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
        "{vibrated_light_rough:.2f},",
        "at most {boundaries_most_share_percent:.0f} % of the energy: where it puts in less than "
        "0.3 %, R shifts by no more than {boundaries_shift_without_rotation:.3f}.",
        "put in less than nothing, down to {boundaries_least_share_percent:.0f} %.",
    ],
    "docs/physics.md": [
        "({theory_friction_of_spin_alone:.2f} for disks at r = 0.9, nearly independent of β)",
        "At μ_s R drops, to {theory_ratio_beyond_spin_alone:.1f} there;",
    ],
}
