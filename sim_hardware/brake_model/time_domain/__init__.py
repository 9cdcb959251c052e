"""The brake in time: fast fixed-rate integration, alone or in batches, exact events, limit cycles, energy."""
