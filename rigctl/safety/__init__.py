"""The watchdog: a process of its own that watches the rig and may stop it; it never starts anything.

Standard library and the words (`rigctl.core`) only. Read in this order: `limits` (what is allowed), `observe`
(one block of readings), `checks` (verdicts), `heartbeat` (is the controller alive and sane), `latch` and
`guard` (decisions), `process` (sockets, clock, signals). Everything but `process`, `evidence` and `realtime`
is free of input, output and clocks.

Not its job: protection of people. That is the hard-wired chain of emergency stop, doors and safe torque off;
software on a PC is no safety-related part of a control system.
"""
