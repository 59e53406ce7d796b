-- Versions of traversals with other true poses, and what is said of sites. No id depends on these rows.

-- A traversal of which a later version stands in every listing: true poses came, or better ones. Nothing is removed,
-- and what rests on the earlier version still finds it.
CREATE TABLE superseded (
    traversal TEXT PRIMARY KEY NOT NULL REFERENCES traversals(id),
    by        TEXT NOT NULL REFERENCES traversals(id)
) STRICT;

CREATE TABLE sites (
    name           TEXT PRIMARY KEY NOT NULL,
    utc_offset_min INTEGER NOT NULL               -- minutes that its clocks are ahead of UTC
) STRICT;
