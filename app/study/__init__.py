"""Studies: methods x data sets x kinds of slices x alignments, on one core, several, or a dask cluster.

A study is a TOML file (`spec`), cut into parts that depend on nothing but themselves (`parts`,
`experiments`); each is kept as it is finished (`keeping`), wherever it was worked out (`executors`),
and all of them make one table (`table`) and one page (`report`).
"""
