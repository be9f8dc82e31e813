"""The event-driven simulation: compiled, deterministic, independent of files and workflows.

Units: the radius a and the mass m of a particle, and the time T such that the initial temperature
is 1 m a^2/T^2. A gas that cools is rescaled on the way: in the kernel velocities are in 2^e a/T and
times in T/2^e, the current units, with e = State.counts[EXPONENT]. Times count from the clock's
base, State.clock[BASE], an instant that is moved along with the run, unless they are called
absolute.

Arguments that recur: `state` is a State, `scene` a Scene (roughgas.scene), `effects` its Effects;
`i` and `j` are numbers of particles, the indices of their rows in memory; `account` is the index of
an effect's account in the energy balance, State.ledger. Spins are surface velocities a w, for the
angular velocity w. Vectors are tuples of D components, in the plane D = 2 and in space D = 3. The
shortlist, State.shortlist, has candidates for contacts. r is the normal restitution, beta the
roughness, q = I/(m a^2) the reduced moment of inertia, mu the coefficient of friction.
"""
