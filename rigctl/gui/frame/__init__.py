"""What is always visible: state bar, navigation, alarm bar with STOP."""
