"""Studies of brake models for people: figures, tables and files of what `sim_hardware.brake_model` computes.

Also the long studies (parallel, interruptible) and the paper's own figures. NOT its job: mechanics,
command line.
"""
