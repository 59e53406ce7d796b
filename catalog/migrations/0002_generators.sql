-- Generators, and what the quality gate measured of them on an experience's images.

CREATE TABLE generators (
    id        TEXT PRIMARY KEY NOT NULL,
    name      TEXT NOT NULL,                      -- several may share one: the latest answers to it
    kind      TEXT NOT NULL,                      -- otf | invariant | identity | gamma | noise | blur | command | onnx
    number    INTEGER NOT NULL                    -- rises with every generator
) STRICT;
CREATE INDEX generators_by_name ON generators (name);

CREATE TABLE gates (
    generator TEXT NOT NULL REFERENCES generators(id),
    parent    TEXT NOT NULL REFERENCES experiences(id),
    domainness REAL NOT NULL,
    object    TEXT NOT NULL,                      -- the gate's record
    PRIMARY KEY (generator, parent, domainness)
) STRICT;
