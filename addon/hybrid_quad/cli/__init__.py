"""The command line ``hybrid-quad``."""
