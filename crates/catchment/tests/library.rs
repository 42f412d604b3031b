//! The library as its users see it, in one test program: a test program takes longer to link than most of these tests
//! take to run.

mod designs;
mod field;
mod layers;
mod own_halves;
mod parts;
mod pieces;
mod placed;
mod planar_sums;
mod proposal;
mod run;
mod seat;
mod stored;
mod sweep;
mod threads;
mod tight_fits;
mod trials;
mod waypoints;
