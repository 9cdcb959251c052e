"""CAN buses and CANopen nodes for all drivers: `session.CanSession`, `canopen_node.CanopenNode`."""
