//! From triangles in memory to their area of acceptance: no file, no path.
#![allow(clippy::print_stdout, reason = "an example tells what it found")]

use catchment::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A square pyramid and its socket, drawn facing +z from their face centres: rim, apex, and the base behind.
    let (d, h, base) = (0.5, 0.25, 0.5);
    let rim = |z: f64| [[-d, -d, z], [d, -d, z], [d, d, z], [-d, d, z]].map(DVec3::from_array);
    let fan = |ring: [DVec3; 4], tip: DVec3| (0..4).map(move |k| [ring[k], ring[(k + 1) % 4], tip]);
    let mut plug: Vec<[DVec3; 3]> = fan(rim(-h), DVec3::new(0.0, 0.0, h)).collect();
    plug.extend([[0, 2, 1], [0, 3, 2]].map(|t| t.map(|k| rim(-h)[k])));
    let (top, bottom) = (rim(h), rim(-base));
    let mut socket: Vec<[DVec3; 3]> = fan(top, DVec3::new(0.0, 0.0, -h)).collect();
    for (k, next) in [(0, 1), (1, 2), (2, 3), (3, 0)] {
        socket.extend([[bottom[k], bottom[next], top[next]], [bottom[k], top[next], top[k]]]);
    }
    socket.extend([[0, 2, 1], [0, 3, 2]].map(|t| t.map(|k| bottom[k])));

    let free = [Dof::X, Dof::Y, Dof::Yaw].into_iter().collect();
    let alignment = Alignment::new(free, Mount::X);
    let problem = Problem::new(HalfSource::Triangles(socket), HalfSource::Triangles(plug), alignment)?;
    let answer = Run::default().on(&problem, &Exec::new())?;
    println!("Sum {:.2} {}", answer.sum(), answer.unit());
    let poses = [0.1, 0.3, 0.9].map(|x| PoseError { x, yaw: 0.2, ..PoseError::default() });
    for (pose, end) in poses.iter().zip(problem.follow_many(&poses, &Exec::new())?) {
        println!("x = {} D ends {}", pose.x, end.outcome.name());
    }
    Ok(())
}
