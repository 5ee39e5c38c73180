//! Builds and runs the program, as another program would.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use serde_json::Value;
use tempfile::TempDir;

use crate::check::WornObj;
use crate::mesh::Mesh;
use crate::write;

/// What a run of the program left behind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Run {
    /// Its exit code; `None` if a signal ended it.
    pub code: Option<i32>,
    /// Its standard output.
    pub stdout: String,
    /// Its standard error.
    pub stderr: String,
}

/// The built program, in the profile of the running test.
///
/// # Panics
/// If it does not build.
pub fn program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM
        .get_or_init(|| built("wovenfit").join(format!("wovenfit{}", std::env::consts::EXE_SUFFIX)))
}

/// The built shared library, in the profile of the running test.
///
/// # Panics
/// If it does not build.
pub fn library() -> &'static Path {
    static LIBRARY: OnceLock<PathBuf> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
        built("wovenfit-ffi").join(format!("{DLL_PREFIX}wovenfit{DLL_SUFFIX}"))
    })
}

/// The folder in which a package was built.
fn built(package: &str) -> PathBuf {
    // target/PROFILE/deps/TEST-hash
    let test = std::env::current_exe().expect("a test knows its own file");
    let profile = test.ancestors().nth(2).expect("tests lie in target/PROFILE/deps");
    let target = profile.parent().expect("a profile lies in target");
    let release = profile.file_name().is_some_and(|name| name == "release");
    let mut build = Command::new(env!("CARGO"));
    build
        .args(["build", "--quiet", "--package", package, "--target-dir"])
        .arg(target)
        .args(release.then_some("--release"))
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."));
    let built = build.output().expect("cargo runs");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    profile.to_path_buf()
}

/// Runs the program.
///
/// # Panics
/// If it cannot be started.
pub fn run<S: AsRef<std::ffi::OsStr>>(args: impl IntoIterator<Item = S>) -> Run {
    run_with(args, &[])
}

/// Runs the program with more environment variables.
///
/// # Panics
/// If it cannot be started.
pub fn run_with<S: AsRef<std::ffi::OsStr>>(
    args: impl IntoIterator<Item = S>,
    variables: &[(&str, &str)],
) -> Run {
    let output = Command::new(program())
        .args(args)
        .envs(variables.iter().copied())
        .output()
        .expect("the program starts");
    Run {
        code: output.status.code(),
        stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

impl Run {
    /// The run itself, if it ended well.
    ///
    /// # Panics
    /// If it did not.
    #[track_caller]
    #[must_use]
    pub fn succeeded(self) -> Self {
        assert_eq!(self.code, Some(0), "stderr:\n{}", self.stderr);
        self
    }

    /// The message of a refusal with this exit code: one that names every word asked for.
    ///
    /// # Panics
    /// If it ended otherwise, panicked, or says something else.
    #[track_caller]
    pub fn refused(&self, code: i32, words: &[&str]) -> &str {
        assert_eq!(self.code, Some(code), "stderr:\n{}", self.stderr);
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
        let said = self.stderr.to_lowercase();
        for word in words {
            assert!(said.contains(&word.to_lowercase()), "`{word}` is not in:\n{}", self.stderr);
        }
        &self.stderr
    }

    /// Standard output as JSON.
    ///
    /// # Panics
    /// If it is none.
    #[track_caller]
    #[must_use]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout)
            .unwrap_or_else(|error| panic!("{error} in:\n{}", self.stdout))
    }
}

/// A folder of one test with its input and output files; gone when dropped.
#[derive(Debug)]
pub struct Bench {
    folder: TempDir,
}

impl Default for Bench {
    fn default() -> Self {
        Self::new()
    }
}

impl Bench {
    /// A new empty folder.
    ///
    /// # Panics
    /// If none can be made.
    #[must_use]
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a temporary folder") }
    }

    /// The path of a file or folder in it.
    #[must_use]
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file into it.
    ///
    /// # Panics
    /// If it cannot be written.
    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, bytes).expect("the folder takes files");
        path
    }

    /// Writes a mesh and a design and runs `flatten` on them, results into `out` inside.
    ///
    /// # Panics
    /// If the files cannot be written.
    pub fn flatten(&self, mesh: &Mesh, design: &Value, args: &[&str]) -> Run {
        let surface = self.write("surface.obj", write::obj(mesh));
        self.flatten_file(&surface, design, args, &[])
    }

    /// Runs `flatten` on a file with more environment variables, results into `out` inside.
    ///
    /// # Panics
    /// If the design cannot be written.
    pub fn flatten_file(
        &self,
        surface: &Path,
        design: &Value,
        args: &[&str],
        variables: &[(&str, &str)],
    ) -> Run {
        let design = self.write("design.json", design.to_string());
        let mut all = vec!["flatten".into(), surface.to_path_buf()];
        all.extend(["--design".into(), design, "--out".into(), self.path("out")]);
        all.extend(args.iter().map(PathBuf::from));
        run_with(all, variables)
    }

    /// The bytes of a result.
    ///
    /// # Panics
    /// If there is no such file.
    #[must_use]
    pub fn out(&self, name: &str) -> Vec<u8> {
        let path = self.path("out").join(name);
        std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// The result `worn.obj`.
    ///
    /// # Panics
    /// If it is missing or no such file.
    #[must_use]
    pub fn worn(&self) -> WornObj {
        WornObj::parse(&String::from_utf8(self.out("worn.obj")).expect("OBJ is text"))
    }

    /// The result `report.json`.
    ///
    /// # Panics
    /// If it is missing or no JSON.
    #[must_use]
    pub fn report(&self) -> Value {
        serde_json::from_slice(&self.out("report.json")).expect("report.json is JSON")
    }

    /// The names of all results, sorted; none if there is no folder.
    #[must_use]
    pub fn results(&self) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(self.path("out"))
            .into_iter()
            .flatten()
            .map(|entry| {
                let entry = entry.expect("a readable folder");
                entry.file_name().to_string_lossy().into_owned()
            })
            .collect();
        names.sort();
        names
    }
}
