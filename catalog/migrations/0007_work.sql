-- What runs took and where they failed: for cost estimates and `furrow run --failed`. No result depends on these rows.

CREATE TABLE timings (
    stage     TEXT NOT NULL,                      -- as progress names it, without slots and labels
    subject   TEXT NOT NULL,                      -- the codebook that was trained; else empty
    units     INTEGER NOT NULL,
    seconds   REAL NOT NULL,
    threads   INTEGER NOT NULL,
    number    INTEGER NOT NULL                    -- rises with every row
) STRICT;
CREATE INDEX timings_by_stage ON timings (stage, number);

CREATE TABLE failures (
    cell      TEXT PRIMARY KEY NOT NULL,
    run       TEXT NOT NULL,
    reason    TEXT NOT NULL
) STRICT;
