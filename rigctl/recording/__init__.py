"""Recording: braking files, the recorder process, the campaign folder, recovery after a crash.

Job: keep what was acquired, whatever dies. Samples go to a CRC-framed spool (`spool`), a finished braking
becomes one NeXus file (`braking_file`), a campaign is a folder of them (`campaign`). NOT its job: finding
squeal (`rigctl.signals`), pictures and reports (`rigctl.analysis`), deciding what to run (`rigctl.engine`).
"""
