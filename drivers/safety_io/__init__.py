"""Safety I/O on CAN: the controller's read-back (`can_channel`), the watchdog's channel (`watchdog_link`)."""
