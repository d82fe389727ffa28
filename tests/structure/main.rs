//! The rules that keep the house in shape: twins that read as twins, modules and files in one order, files that can be
//! read in one sitting, names that mean one thing.

mod modules;
mod names;
mod sources;
mod statements;
mod twins;
