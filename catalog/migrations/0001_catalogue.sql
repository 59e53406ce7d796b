-- The index over the object store: rows point at immutable objects, which hold all that was measured.

CREATE TABLE recordings (
    id        TEXT PRIMARY KEY NOT NULL,          -- digest of the recording's bytes
    name      TEXT NOT NULL,                      -- file or folder name it first came under
    bytes     INTEGER NOT NULL
) STRICT;

CREATE TABLE recording_parts (
    recording TEXT NOT NULL REFERENCES recordings(id),
    ordinal   INTEGER NOT NULL,
    digest    TEXT NOT NULL,                      -- names the file in recordings/
    name      TEXT NOT NULL,
    bytes     INTEGER NOT NULL,
    PRIMARY KEY (recording, ordinal)
) STRICT;

CREATE TABLE experiences (
    id        TEXT PRIMARY KEY NOT NULL,
    site      TEXT NOT NULL,
    route     TEXT NOT NULL,
    slot      TEXT NOT NULL,
    kind      TEXT NOT NULL,                      -- recorded | generated
    parent    TEXT REFERENCES experiences(id),
    nodes     INTEGER NOT NULL
) STRICT;
CREATE INDEX experiences_by_place ON experiences (site, slot);

CREATE TABLE traversals (
    id        TEXT PRIMARY KEY NOT NULL,
    recording TEXT NOT NULL REFERENCES recordings(id),
    site      TEXT NOT NULL,
    route     TEXT NOT NULL,
    slot      TEXT NOT NULL,
    purpose   TEXT NOT NULL,                      -- experience | evaluation | vocabulary
    request   TEXT NOT NULL UNIQUE,               -- digest of what was asked: the same request is answered from here
    experience TEXT REFERENCES experiences(id)
) STRICT;
CREATE INDEX traversals_by_place ON traversals (site, purpose, slot);

CREATE TABLE codebooks (
    id        TEXT PRIMARY KEY NOT NULL,
    site      TEXT NOT NULL,
    words     INTEGER NOT NULL
) STRICT;

CREATE TABLE outcomes (
    cell      TEXT PRIMARY KEY NOT NULL,
    object    TEXT NOT NULL
) STRICT;

CREATE TABLE runs (
    id        TEXT PRIMARY KEY NOT NULL,
    matrix    TEXT NOT NULL,
    object    TEXT NOT NULL,                      -- the run's record: matrix text and cells
    number    INTEGER NOT NULL                    -- rises with every run
) STRICT;
