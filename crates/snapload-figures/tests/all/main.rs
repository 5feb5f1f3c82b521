//! All tests of pictures from outside, as one program: it is linked once, and the tests of all
//! files run side by side.

mod insets;
mod maps;
mod names;
mod paper;
mod pictures;
mod pixels;
