"""The bench: the simulated rig behind real wires, so that the real drivers talk to it byte by byte."""
