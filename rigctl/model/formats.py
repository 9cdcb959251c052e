"""File formats that a study can be written in. Light: the command line imports it for its help."""

FIGURE_FORMATS = ("png", "svg")
TABLE_FORMATS = ("csv", "parquet")
FORMATS = (*FIGURE_FORMATS, *TABLE_FORMATS, "json")
