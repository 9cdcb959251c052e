"""Serial devices of the bench: ports, the byte-level fault seam, and emulated devices written from the
manuals.

Start reading at `ports.SerialPort`; `bench.make_ports` builds all of them. Nothing here imports a driver or a
vendor library.
"""
