"""What a result takes along from its source: a file for each kind, all over one correspondence of the two surfaces.

`layers.read` copies what a source carries, before the run; `layers.write` puts it on the result, after it. `object_data`
does what belongs to the object.
"""
