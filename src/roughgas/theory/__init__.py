"""Theory of gases of rough, inelastic disks and spheres: closed forms and rate equations.

Functions take plain numbers or numpy arrays that broadcast against each other, in double precision;
plain numbers return a numpy float. Arguments are checked: an illegal argument, or NaN, raises
`roughgas.base.InputError`. Common arguments are `r` in [0, 1] and `beta` in [-1, 1], the normal and
tangential restitution; `dimension` D, an int, 2 or 3; and `inertia` q = I/(m a^2) > 0, by default
the value of uniform disks or spheres.

Units: particle radius a, mass m and time unit T are 1. A granular temperature is T = 2 E, twice the
kinetic energy per degree of freedom: T_tr = m <v^2>/D and T_rot = m q a^2 <omega^2>/(2D-3), in
m a^2/T^2. theta = T_rot/T_tr = 1/K and R = theta/(1 + theta). Time is often counted in collisions
per particle: a collision counts for both its particles.
"""

from roughgas.theory.arguments import moment_of_inertia
from roughgas.theory.baths import (
    KineticPressure,
    mean_spin_decay,
    mean_spin_of_spinners,
    pressure_in_sheared_bath,
)
from roughgas.theory.closed_forms import (
    a_G,
    b_G,
    c_G,
    collision_frequency,
    contact_value,
    cooling_K,
    cooling_ratio,
    correlated_ratio,
    goldshtein_ratio,
    lun_ratio,
    mean_free_path,
    number_density,
    packing_fraction,
    shear_factor,
)
from roughgas.theory.friction import (
    RUNAWAY_R,
    cooling_rate,
    critical_friction,
    friction_changes,
    friction_ratio,
    friction_relaxation_rate,
    maxwellian_share,
    runaway_growth,
    runaway_rate,
    runaway_spin,
    runaway_time,
    sliding_fraction,
    spinner_temperature,
)
from roughgas.theory.mixture_states import (
    compressibility,
    kick_power,
    mimicry_masses,
    mixture_contact_values,
    mixture_cooling,
    mixture_decay_rate,
    mixture_density,
    mixture_driven,
    mixture_frequency,
    mixture_relaxation_rate,
    mixture_rotation,
)
from roughgas.theory.mixtures import Mixture, Temperatures, mixture, mixture_changes
from roughgas.theory.rate_equations import (
    Rates,
    Relaxation,
    bath_temperatures,
    collision_rates,
    collisions_to_relax,
    decay_rate,
    delta_temperatures,
    drive_changes,
    driven_temperatures,
    haff_temperature,
    haff_time,
    mean_normal_squared,
    mean_spin_squared,
    mean_tangential_squared,
    relax,
    relaxation_rate,
    rotational_energy_change,
    stationary_ratio,
    stationary_theta,
    temperature_changes,
    translational_energy_change,
)
from roughgas.theory.sonine import Cumulants, sonine_state
from roughgas.theory.transport import (
    fourier_flux,
    free_molecular_flux,
    heat_flux,
    rotational_diffusion,
    self_diffusion,
    shear_viscosity,
    spin_corrections,
    thermal_conductivity,
)
from roughgas.theory.viscoelastic import (
    maxwellian_restitution,
    viscoelastic_cooling,
    viscoelastic_ratio,
    viscoelastic_restitution,
    viscoelastic_temperature,
    viscoelastic_time,
)

__all__ = [name for name, public in globals().items() if callable(public)]
