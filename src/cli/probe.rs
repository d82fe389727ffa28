//! `skilltree probe`: one robot under given actions, and all that it observed.

use super::console::print;
use super::error::{CliError, exit_codes};
use crate::backend::Backend;
use crate::backend::cpu::cpu_backend;
use crate::config::plan::Action;
use crate::config::{Overrides, load};
use crate::env::motion::{COLLISION, DOCKED};
use crate::layout::Robot;
use crate::train::observation::{SILENT, SensorValues, floor_only, robot_at};
use crate::world::{Pose, World};
use clap::ValueEnum;
use glam::Vec2;
use serde::Serialize;
use std::path::PathBuf;

/// Puts a robot somewhere, lets it act, and prints its pose and all sensor readings.
#[derive(Debug, clap::Args)]
#[command(after_help = concat!(
    "Examples:\n",
    "  skilltree probe configs/docking.toml --at L2\n",
    "  skilltree probe configs/docking.toml --at 60,60,225 --actions move+12,turn-15 --json\n\n",
    "Keys of --json: x, y (inches), heading (degrees, 0 = east, counter-clockwise), room, sonar (24 inches, the first ",
    "straight ahead, then counter-clockwise every 15 degrees), light (24 of 0 or 1, same order), bumpers (front, ",
    "left, back, right), compass (degrees), blocked, docked.\n\n",
    exit_codes!()
))]
pub(super) struct ProbeArguments {
    /// The experiment, for its world and noise.
    config: PathBuf,
    /// Where it starts: inches to the right, inches up, heading in degrees (0 = east, counter-clockwise); or
    /// the name of a place of the world.
    #[arg(long, value_name = "X,Y,HEADING", allow_hyphen_values = true)]
    at: String,
    /// What it does, in order, separated by commas: turn+15, turn-15, turn+60, turn-60 (degrees, counter-clockwise),
    /// move+12, move-12 (inches).
    #[arg(long, value_name = "ACTIONS", default_value = "", hide_default_value = true, allow_hyphen_values = true)]
    actions: String,
    /// Whether actuators and sensors are noisy as in the config.
    #[arg(long, value_enum, default_value = "on")]
    noise: Noisy,
    /// Picks the random numbers of the noise.
    #[arg(long, default_value_t = 0)]
    seed: u32,
    /// One JSON object per line: the start pose, then one per action.
    #[arg(long)]
    json: bool,
    /// Sets a key of the config, such as `robot.noise.sonar=0.2`; may be given several times.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Noisy {
    On,
    Off,
}

/// One line of output.
#[derive(Debug, Serialize)]
struct ProbeReading {
    x: f32,
    y: f32,
    heading: f32,
    room: Option<String>,
    #[serde(flatten)]
    sensed: SensorValues,
    blocked: bool,
    docked: bool,
}

pub(super) fn probe(arguments: &ProbeArguments) -> Result<(), CliError> {
    let plan = load(&arguments.config, &Overrides { set: arguments.set.clone(), ..Overrides::default() })?;
    let pose = pose_of(&arguments.at, plan.world())?;
    let actions = actions_of(&arguments.actions)?;
    let noise = if arguments.noise == Noisy::Off { SILENT } else { plan.arms[0].noise };
    let shared = floor_only(plan.world());
    let mut backend = cpu_backend(1, None)?;
    let mut robot = robot_at(pose, &noise, plan.run_seed, arguments.seed);
    for action in std::iter::once(None).chain(actions.into_iter().map(Some)) {
        if let Some(action) = action {
            robot.action = action as u32;
        }
        robot.events = 0;
        backend.step(&shared, std::slice::from_mut(&mut robot), 1)?;
        let reading = reading_of(&robot, plan.world());
        if arguments.json {
            print(&(serde_json::to_string(&reading).unwrap_or_default() + "\n"))?;
        } else {
            print(&text_of(action, &reading))?;
        }
    }
    Ok(())
}

fn reading_of(robot: &Robot, world: &World) -> ProbeReading {
    let room = world.room_of(Vec2::new(robot.x, robot.y)).map(|room| world.rooms[room].name.clone());
    ProbeReading {
        x: robot.x,
        y: robot.y,
        heading: robot.heading,
        room,
        sensed: SensorValues::of(robot),
        blocked: robot.events & (COLLISION | DOCKED) != 0,
        docked: robot.events & DOCKED != 0,
    }
}

fn text_of(action: Option<Action>, reading: &ProbeReading) -> String {
    let list = |values: &[u32]| values.iter().map(u32::to_string).collect::<Vec<_>>().join(" ");
    let bits = |values: &[u8]| values.iter().map(|bit| if *bit == 1 { '*' } else { '.' }).collect::<String>();
    let name = action.map_or("start", Action::name);
    let room = reading.room.as_deref().unwrap_or("none");
    let outcome = match (reading.docked, reading.blocked) {
        (true, _) => "  DOCKED",
        (false, true) => "  blocked",
        (false, false) => "",
    };
    format!(
        "{name:8} x {:.2}  y {:.2}  heading {:.1}  room {room}{outcome}\n\
        \x20 sonar   {}\n\
        \x20 light   {}  (front first, counter-clockwise)\n\
        \x20 bumpers {}  (front left back right)\n\
        \x20 compass {:.1}\n",
        reading.x,
        reading.y,
        reading.heading,
        list(&reading.sensed.sonar),
        bits(&reading.sensed.light),
        bits(&reading.sensed.bumpers),
        reading.sensed.compass,
    )
}

fn usage(message: String, hint: &str) -> CliError {
    CliError::Usage { message, hint: hint.to_owned() }
}

/// A pose or the name of a place, checked to be free.
fn pose_of(text: &str, world: &World) -> Result<Pose, CliError> {
    if let Some((_, pose)) = world.places.iter().find(|(name, _)| name == text) {
        return Ok(*pose);
    }
    let places: Vec<&str> = world.places.iter().map(|(name, _)| name.as_str()).collect();
    let named =
        if places.is_empty() { String::new() } else { format!(", or the name of a place: {}", places.join(", ")) };
    let hint = format!("write --at X,Y,HEADING, as in --at 60,60,225{named}");
    let numbers: Vec<f32> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    let [x, y, heading] = numbers[..] else {
        return Err(usage(format!("--at {text}: not three numbers"), &hint));
    };
    if text.split(',').count() != 3 || !(x.is_finite() && y.is_finite() && heading.is_finite()) {
        return Err(usage(format!("--at {text}: not three finite numbers"), &hint));
    }
    let point = Vec2::new(x, y);
    if !world.is_free(point) {
        let message = format!("--at {text}: a robot does not fit there (clearance {:.1} in)", world.clearance(point));
        let hint = format!(
            "its radius is 12 in and the world is {} x {} in; keep clear of walls and boxes",
            world.size.x, world.size.y
        );
        return Err(usage(message, &hint));
    }
    Ok(Pose::new(x, y, heading))
}

fn actions_of(text: &str) -> Result<Vec<Action>, CliError> {
    let names: Vec<&str> = Action::ALL.iter().map(|action| action.name()).collect();
    text.split(',')
        .map(str::trim)
        .filter(|name| !name.is_empty())
        .map(|name| {
            Action::ALL.into_iter().find(|action| action.name() == name).ok_or_else(|| {
                usage(format!("--actions: no action is called `{name}`"), &format!("choose among {}", names.join(", ")))
            })
        })
        .collect()
}
