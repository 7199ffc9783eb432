"""Web pages of one file each that ask for nothing outside themselves."""
