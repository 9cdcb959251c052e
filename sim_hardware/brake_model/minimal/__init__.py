"""Minimal models of squeal (Table 1, section 1): one mechanism each, small enough for closed formulas.

Modules: `laws` (friction laws), `belt` (1-DOF oscillator on a moving belt: equilibrium, criterion, eqs
28-31), `phases` and `motion` (slip, stick and reversed sliding with exact events), `cycles` (limit cycles,
regions of the phase plane, frequency over belt speed), `sprag` (Spurr's geometric instability), `two_dof`
(eq 1), `hurwitz` (its five boundaries in mu, for any 2-DOF system with a stiffness linear in mu), `cases`
(systems of the literature as data). Pure numerics, SI units. NOT its job: the 14-DOF brake, figures, files.
"""
