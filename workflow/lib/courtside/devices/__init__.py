"""Files of recording devices into records."""
