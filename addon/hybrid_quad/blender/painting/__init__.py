"""The tool that paints guides, in Object and Sculpt Mode: settings, operators, storage, drawing."""
