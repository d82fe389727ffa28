//! `skilltree keys`: the reference of every key.

use super::console::print;
use super::error::{CliError, exit_codes};
use crate::config::reference;
use clap::ValueEnum;

/// Prints what every key of a config or world file means, what it may be, and its default.
#[derive(Debug, clap::Args)]
#[command(after_help = concat!(
    "Examples:\n",
    "  skilltree keys learning_rate\n",
    "  skilltree keys skill.dock.goal\n",
    "  skilltree keys --json-schema config > configs/schema.json\n\n",
    "Editors that know TOML complete and check a config that begins with `#:schema schema.json`.\n\n",
    exit_codes!()
))]
pub(super) struct KeysArguments {
    /// Only keys with this in their path or in what is said of them.
    #[arg(value_name = "PATTERN", default_value = "", hide_default_value = true)]
    pattern: String,
    /// Print a JSON schema for editors instead.
    #[arg(long, value_name = "FILE", conflicts_with = "pattern")]
    json_schema: Option<SchemaOf>,
}

/// Which files a schema is for.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum SchemaOf {
    Config,
    World,
}

pub(super) fn keys(arguments: &KeysArguments) -> Result<(), CliError> {
    let schema = match arguments.json_schema {
        Some(SchemaOf::Config) => reference::config_schema(),
        Some(SchemaOf::World) => reference::world_schema(),
        None => {
            let found = reference::text(&arguments.pattern);
            return if found.is_empty() {
                Err(CliError::Usage {
                    message: format!("no key matches `{}`", arguments.pattern),
                    hint: "`skilltree keys` prints all of them".to_owned(),
                })
            } else {
                print(&found)
            };
        }
    };
    print(&format!("{schema:#}\n"))
}
