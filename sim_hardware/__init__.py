"""Everything that stands in for hardware: the brake model, the plant around it and the simulated devices.

NOT its job: running programs, watching limits or recording. Those live in `rigctl` and know nothing of this
package except through the registry of devices.
"""
