//! The library as its users have it, in one program: a test program takes longer to link than most of these take to run.

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
