"""Speed drives on serial lines: Modbus RTU (`modbus`) and Eurotherm 590 EI-Bisynch (`eurotherm590`).

`polled.PolledDrive` is what both have in common; the rest says how to talk to one kind of drive.
"""
