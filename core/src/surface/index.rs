//! Typed indices: a vertex cannot be mistaken for a triangle.

use std::fmt;

macro_rules! index {
    ($(#[$doc:meta])* $name:ident, $word:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(u32);

        impl $name {
            /// The index `i`.
            ///
            /// # Panics
            /// If `i` does not fit 32 bits; surfaces of that size are refused when read.
            #[must_use]
            pub fn new(i: usize) -> Self {
                Self(u32::try_from(i).expect("surfaces have fewer than 2^32 elements"))
            }

            /// The index as a number.
            #[must_use]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl fmt::Debug for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($word, " {}"), self.0)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($word, " {}"), self.0)
            }
        }
    };
}

index!(
    /// A vertex of a [`Surface`](super::Surface).
    VertexId,
    "vertex"
);
index!(
    /// A triangle of a [`Surface`](super::Surface).
    TriangleId,
    "triangle"
);
index!(
    /// A half-edge of a [`Surface`](super::Surface): `3 t + k` runs along triangle `t` from its
    /// corner `k` to its corner `(k + 1) % 3`.
    HalfEdgeId,
    "half-edge"
);

impl HalfEdgeId {
    /// The half-edge of triangle `t` that starts at its corner `k`.
    #[must_use]
    pub fn of(t: TriangleId, k: usize) -> Self {
        Self::new(3 * t.index() + k)
    }

    /// The triangle it belongs to.
    #[must_use]
    pub fn triangle(self) -> TriangleId {
        TriangleId::new(self.index() / 3)
    }

    /// The corner of its triangle at which it starts.
    #[must_use]
    pub fn corner(self) -> usize {
        self.index() % 3
    }

    /// The next half-edge of the same triangle.
    #[must_use]
    pub fn next(self) -> Self {
        Self::of(self.triangle(), (self.corner() + 1) % 3)
    }

    /// The previous half-edge of the same triangle.
    #[must_use]
    pub fn prev(self) -> Self {
        Self::of(self.triangle(), (self.corner() + 2) % 3)
    }
}
