"""Live signals: rolling envelopes, spectra and levels of what the acquisition writes into the ring."""
