//! Places within a plan: a type for each list, so that no live traversal's place is taken for a contender's.

macro_rules! place_in_plan {
    ($($(#[$doc:meta])* $name:ident),*) => {
        $(
            $(#[$doc])*
            #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
            pub struct $name(pub usize);

            impl $name {
                /// All places of a list of this length, in order.
                pub fn all(length: usize) -> impl Iterator<Item = Self> + Clone {
                    (0..length).map(Self)
                }
            }
        )*
    };
}

place_in_plan!(
    /// Which of a plan's live traversals.
    LiveIx,
    /// Which of a plan's contenders.
    ContenderIx,
    /// Which of a plan's cells.
    CellIx
);
