//! Writing results: all files of a run appear complete, or none does.
//!
//! They are first written into a temporary folder on the same file system and then renamed, which
//! replaces a file in one step. If a rename fails, what was there before is put back. Only the
//! named files are touched; whatever else lies in the folder stays.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::exit::Failure;

/// A file to write: its name inside the folder, and its contents.
pub type Named = (String, Vec<u8>);

/// Whether files can be written into `folder`; asked before the long work, not after it.
pub fn ready(folder: &Path) -> Result<(), Failure> {
    if folder.exists() && !folder.is_dir() {
        return Err(Failure::new("this is a file: give a folder for the results").at(folder));
    }
    temporary(existing_ancestor(folder)).map(drop).map_err(|error| cannot_write(folder, &error))
}

/// Writes `files` into `folder`, which is made if there is none: all of them or none.
pub fn write_together(folder: &Path, files: &[Named]) -> Result<(), Failure> {
    place(folder, files).map_err(|error| cannot_write(folder, &error))
}

fn cannot_write(folder: &Path, error: &io::Error) -> Failure {
    Failure::new(format!("cannot write into this folder: {error}")).at(folder)
}

fn place(folder: &Path, files: &[Named]) -> io::Result<()> {
    let made = folders_to_make(folder);
    let result = place_into(folder, files);
    if result.is_err() {
        // Ours and empty, or they stay.
        made.iter().rev().for_each(|path| drop(fs::remove_dir(path)));
    }
    result
}

fn place_into(folder: &Path, files: &[Named]) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let work = temporary(folder)?;
    let (fresh, former) = (work.path().join("new"), work.path().join("old"));
    fs::create_dir(&fresh)?;
    fs::create_dir(&former)?;
    for (name, contents) in files {
        let target = folder.join(name);
        if target.is_dir() {
            let message = format!("`{name}` is a folder there; move it away");
            return Err(io::Error::new(io::ErrorKind::IsADirectory, message));
        }
        let mut file = File::create(fresh.join(name))?;
        file.write_all(contents)?;
        file.sync_all()?;
    }
    for (done, (name, _)) in files.iter().enumerate() {
        if let Err(error) = exchange(name, &fresh, folder, &former) {
            for (name, _) in files[..=done].iter().rev() {
                restore(name, folder, &former, &fresh);
            }
            return Err(error);
        }
    }
    Ok(())
}

/// Moves the file `name` from `fresh` into `folder`, and what was there into `former`.
fn exchange(name: &str, fresh: &Path, folder: &Path, former: &Path) -> io::Result<()> {
    let target = folder.join(name);
    if target.symlink_metadata().is_ok() {
        // A hard link would keep the name filled at every moment, but not all file systems have
        // them; a crash between the two renames leaves the former file in the hidden folder.
        fs::rename(&target, former.join(name))?;
    }
    fs::rename(fresh.join(name), target)
}

/// Undoes [`exchange`] as far as it came.
fn restore(name: &str, folder: &Path, former: &Path, fresh: &Path) {
    let before = former.join(name);
    if before.symlink_metadata().is_ok() {
        drop(fs::rename(before, folder.join(name)));
    } else if fresh.join(name).symlink_metadata().is_err() {
        drop(fs::remove_file(folder.join(name)));
    }
}

/// A hidden folder inside `folder`, on its file system; it removes itself.
fn temporary(folder: &Path) -> io::Result<TempDir> {
    tempfile::Builder::new().prefix(".wovenfit-").tempdir_in(folder)
}

/// The ancestors of `folder`, itself included, that do not exist yet, the outermost first.
fn folders_to_make(folder: &Path) -> Vec<PathBuf> {
    let missing = folder.ancestors().take_while(|p| !p.as_os_str().is_empty() && !p.exists());
    let mut missing: Vec<PathBuf> = missing.map(Path::to_owned).collect();
    missing.reverse();
    missing
}

fn existing_ancestor(folder: &Path) -> &Path {
    let existing = folder.ancestors().find(|p| p.exists());
    existing.unwrap_or_else(|| Path::new("."))
}

/// Prints to standard output. Whoever closed it does not want to read on.
pub fn say(text: &str) {
    drop(io::stdout().lock().write_all(text.as_bytes()));
}

/// Prints to standard error.
pub fn tell(text: &str) {
    drop(io::stderr().lock().write_all(text.as_bytes()));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(names: &[&str], contents: &str) -> Vec<Named> {
        names.iter().map(|name| ((*name).to_owned(), contents.as_bytes().to_vec())).collect()
    }

    fn listing(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<String> =
            entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_new_folder_holds_the_files_and_nothing_else() {
        let base = tempfile::tempdir().unwrap();
        let folder = base.path().join("a/b");
        write_together(&folder, &files(&["x", "y"], "1")).unwrap();
        assert_eq!(listing(&folder), ["x", "y"]);
        assert_eq!(listing(base.path()), ["a"]);
    }

    #[test]
    fn in_a_folder_that_exists_only_our_files_are_replaced() {
        let base = tempfile::tempdir().unwrap();
        fs::write(base.path().join("mine"), "keep").unwrap();
        fs::write(base.path().join("x"), "former").unwrap();
        write_together(base.path(), &files(&["x", "y"], "1")).unwrap();
        assert_eq!(listing(base.path()), ["mine", "x", "y"]);
        assert_eq!(fs::read_to_string(base.path().join("mine")).unwrap(), "keep");
        assert_eq!(fs::read_to_string(base.path().join("x")).unwrap(), "1");
    }

    #[test]
    fn when_one_file_cannot_be_placed_none_is() {
        let base = tempfile::tempdir().unwrap();
        fs::write(base.path().join("x"), "former").unwrap();
        fs::create_dir(base.path().join("z")).unwrap();
        let error = write_together(base.path(), &files(&["x", "y", "z"], "1")).unwrap_err();
        assert!(error.to_string().ends_with("`z` is a folder there; move it away"), "{error}");
        assert_eq!(listing(base.path()), ["x", "z"]);
        assert_eq!(fs::read_to_string(base.path().join("x")).unwrap(), "former");
    }

    #[test]
    fn a_failed_exchange_is_undone() {
        let base = tempfile::tempdir().unwrap();
        let path = |name: &str| base.path().join(name);
        for folder in ["target", "new", "old"] {
            fs::create_dir(path(folder)).unwrap();
        }
        fs::write(path("target/x"), "former").unwrap();
        fs::write(path("new/x"), "1").unwrap();
        fs::write(path("new/y"), "1").unwrap();
        for name in ["x", "y"] {
            exchange(name, &path("new"), &path("target"), &path("old")).unwrap();
        }
        // The third file is not there: its exchange fails half-way.
        fs::write(path("target/z"), "former").unwrap();
        exchange("z", &path("new"), &path("target"), &path("old")).unwrap_err();
        for name in ["z", "y", "x"] {
            restore(name, &path("target"), &path("old"), &path("new"));
        }
        assert_eq!(listing(&path("target")), ["x", "z"]);
        assert_eq!(fs::read_to_string(path("target/x")).unwrap(), "former");
        assert_eq!(fs::read_to_string(path("target/z")).unwrap(), "former");
    }

    #[test]
    fn folders_that_were_made_for_nothing_are_removed() {
        let base = tempfile::tempdir().unwrap();
        // No file can have this name: writing fails after the folders were made.
        let error = write_together(&base.path().join("a/b"), &files(&["no/such"], "1"));
        assert!(error.is_err());
        assert!(listing(base.path()).is_empty());
    }

    #[test]
    fn a_file_in_place_of_the_folder_is_told_before_the_work() {
        let base = tempfile::tempdir().unwrap();
        let path = base.path().join("x");
        fs::write(&path, "1").unwrap();
        let error = ready(&path).unwrap_err().to_string();
        assert!(error.ends_with("x: this is a file: give a folder for the results"), "{error}");
        ready(&base.path().join("new/deep")).unwrap();
        assert_eq!(listing(base.path()), ["x"]);
    }
}
