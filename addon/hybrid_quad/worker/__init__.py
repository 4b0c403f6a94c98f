"""A run in a process of its own: it can crash, hang or be killed, and the program that asked for it goes on."""
