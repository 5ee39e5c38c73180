//! A small host: finds the functions by name, turns statuses into results, frees what it got.

use std::ffi::{CString, c_char, c_void};
use std::path::Path;
use std::ptr::null_mut;

use libloading::Library;
use support::mesh::Mesh;

/// The ABI number that the signatures below belong to.
pub const ABI: u32 = 1;

pub const PATTERN: i32 = 1;
pub const POSITIONS: i32 = 3;
pub const VERTEX_WEIGHTS: i32 = 4;
pub const WARP_STRAIN: i32 = 5;
pub const PRESSURE_KPA: i32 = 8;
pub const GIVEN_PATTERN_PER_CORNER: i32 = 20;
pub const GIVEN_WARP_STRAIN: i32 = 21;
pub const GIVEN_PRESSURE_KPA: i32 = 23;
pub const TRIANGLES: i32 = 1;
pub const VERTEX_TO_GIVEN_VERTEX: i32 = 2;
pub const VERTEX_TO_GIVEN_TRIANGLE: i32 = 3;
pub const TRIANGLE_TO_GIVEN_TRIANGLE: i32 = 4;
pub const NONE: u32 = u32::MAX;

/// An object of the library.
pub type Handle = *mut c_void;

/// A refusal: its status and text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    pub status: i32,
    pub text: String,
}

/// The loaded library.
pub struct Host {
    library: Library,
}

/// The C function of a name with a signature; the value that calling it gives.
macro_rules! call {
    ($host:expr, $name:literal, ($($type:ty),* $(,)?) -> $result:ty, $($argument:expr),* $(,)?) => {{
        type Function = unsafe extern "C" fn($($type),*) -> $result;
        // SAFETY: name and signature are those of the header.
        let function = unsafe { $host.function::<Function>($name) };
        // SAFETY: the arguments live through the call and are as long as they say.
        unsafe { function($($argument),*) }
    }};
}

impl Host {
    /// Loads the library at a path and asks whether it has our ABI.
    pub fn load(path: &Path, abi: u32) -> Result<Self, String> {
        // SAFETY: the library runs nothing when it is loaded.
        let library = unsafe { Library::new(path) }
            .map_err(|error| format!("cannot load wovenfit from {}: {error}", path.display()))?;
        let host = Self { library };
        host.find::<unsafe extern "C" fn()>("wovenfit_check_abi")?;
        let refused = |refusal: Refusal| refusal.text;
        host.done(|error| call!(host, "wovenfit_check_abi", (u32, *mut Handle) -> i32, abi, error))
            .map_err(refused)?;
        Ok(host)
    }

    /// A function by its name.
    pub fn find<T: Copy>(&self, name: &str) -> Result<T, String> {
        // SAFETY: whether `T` is its signature is for the caller to know; nothing is called here.
        let symbol = unsafe { self.library.get::<T>(name.as_bytes()) };
        symbol.map(|symbol| *symbol).map_err(|error| format!("{name} is missing: {error}"))
    }

    /// # Safety
    /// `T` is the function's signature.
    unsafe fn function<T: Copy>(&self, name: &str) -> T {
        self.find(name).unwrap_or_else(|error| panic!("{error}"))
    }

    /// A call with a place for its error.
    pub fn done(&self, call: impl FnOnce(*mut Handle) -> i32) -> Result<(), Refusal> {
        let mut error: Handle = null_mut();
        let status = call(&raw mut error);
        if status == 0 {
            assert!(error.is_null());
            return Ok(());
        }
        let get = |buffer: *mut c_char, capacity: usize, needed: *mut usize| {
            call!(
                self,
                "wovenfit_error_text",
                (Handle, *mut c_char, usize, *mut usize) -> i32,
                error,
                buffer,
                capacity,
                needed
            )
        };
        let mut needed = 0;
        assert_eq!(get(null_mut(), 0, &raw mut needed), 0);
        let mut bytes = vec![0u8; needed];
        assert_eq!(get(bytes.as_mut_ptr().cast(), needed, &raw mut needed), 0);
        call!(self, "wovenfit_error_free", (Handle) -> (), error);
        assert_eq!(bytes.pop(), Some(0));
        Err(Refusal { status, text: String::from_utf8(bytes).expect("texts are UTF-8") })
    }

    /// A text, its size asked first.
    pub fn text(
        &self,
        get: impl Fn(*mut c_char, usize, *mut usize, *mut Handle) -> i32,
    ) -> Result<String, Refusal> {
        let mut needed = 0;
        self.done(|error| get(null_mut(), 0, &raw mut needed, error))?;
        let mut bytes = vec![0u8; needed];
        self.done(|error| get(bytes.as_mut_ptr().cast(), needed, &raw mut needed, error))?;
        assert_eq!(bytes.pop(), Some(0));
        Ok(String::from_utf8(bytes).expect("texts are UTF-8"))
    }

    fn made(&self, make: impl FnOnce(*mut Handle, *mut Handle) -> i32) -> Result<Handle, Refusal> {
        let mut handle = null_mut();
        self.done(|error| make(&raw mut handle, error))?;
        Ok(handle)
    }

    /// A mesh of 64-bit coordinates.
    pub fn mesh(&self, mesh: &Mesh, mm_per_unit: f64) -> Handle {
        let points: Vec<f64> = mesh.points.iter().flat_map(|p| p.to_array()).collect();
        let corners: Vec<u32> = mesh.triangles.iter().flatten().map(|&v| v as u32).collect();
        self.made(|out, error| {
            call!(
                self,
                "wovenfit_mesh_new_f64",
                (*const f64, usize, usize, *const u32, usize, f64, *mut Handle, *mut Handle) -> i32,
                points.as_ptr(),
                mesh.points.len(),
                0,
                corners.as_ptr(),
                mesh.triangles.len(),
                mm_per_unit,
                out,
                error
            )
        })
        .expect("a mesh")
    }

    /// A design from its JSON.
    pub fn design(&self, json: &str) -> Result<Handle, Refusal> {
        let json = CString::new(json).expect("no NUL in JSON");
        self.made(|out, error| {
            call!(
                self,
                "wovenfit_design_from_json",
                (*const c_char, f64, *mut Handle, *mut Handle) -> i32,
                json.as_ptr(),
                1.0,
                out,
                error
            )
        })
    }

    /// Parameters with these values.
    pub fn parameters(&self, values: &[(&str, &str)]) -> Handle {
        let parameters = self
            .made(|out, error| {
                call!(self, "wovenfit_parameters_new", (*mut Handle, *mut Handle) -> i32, out, error)
            })
            .expect("parameters");
        for (name, value) in values {
            let (name, value) = (CString::new(*name).unwrap(), CString::new(*value).unwrap());
            self.done(|error| {
                call!(
                    self,
                    "wovenfit_parameters_set",
                    (Handle, *const c_char, *const c_char, *mut Handle) -> i32,
                    parameters,
                    name.as_ptr(),
                    value.as_ptr(),
                    error
                )
            })
            .expect("a value");
        }
        parameters
    }

    /// Runs a job to its end; its result.
    pub fn flatten(
        &self,
        mesh: Handle,
        design: Handle,
        parameters: Handle,
    ) -> Result<Handle, Refusal> {
        let job = self.made(|out, error| {
            call!(
                self,
                "wovenfit_job_start",
                (Handle, Handle, Handle, *mut Handle, *mut Handle) -> i32,
                mesh,
                design,
                parameters,
                out,
                error
            )
        })?;
        self.done(|error| {
            call!(self, "wovenfit_job_wait", (Handle, f64, *mut Handle) -> i32, job, -1.0, error)
        })?;
        let result = self.made(|out, error| {
            call!(
                self,
                "wovenfit_job_result",
                (Handle, *mut Handle, *mut Handle) -> i32,
                job,
                out,
                error
            )
        });
        self.free("wovenfit_job_free", job);
        result
    }

    /// A text of a result.
    pub fn result_text(&self, result: Handle, what: i32) -> String {
        self.text(|buffer, capacity, needed, error| {
            call!(
                self,
                "wovenfit_result_text",
                (Handle, i32, *mut c_char, usize, *mut usize, *mut Handle) -> i32,
                result,
                what,
                buffer,
                capacity,
                needed,
                error
            )
        })
        .expect("a text")
    }

    /// The check's JSON.
    pub fn check(&self, mesh: Handle) -> String {
        let check = self
            .made(|out, error| {
                call!(
                    self,
                    "wovenfit_check_run",
                    (Handle, Handle, Handle, *mut Handle, *mut Handle) -> i32,
                    mesh,
                    null_mut(),
                    null_mut(),
                    out,
                    error
                )
            })
            .expect("a check");
        let json = self.text(|buffer, capacity, needed, error| {
            call!(
                self,
                "wovenfit_check_json",
                (Handle, *mut c_char, usize, *mut usize, *mut Handle) -> i32,
                check,
                buffer,
                capacity,
                needed,
                error
            )
        });
        self.free("wovenfit_check_free", check);
        json.expect("a text")
    }

    /// Numbers of a result.
    pub fn doubles(&self, result: Handle, what: i32) -> Vec<f64> {
        let get = |buffer: *mut f64, capacity: usize, count: *mut usize| {
            self.done(|error| {
                call!(
                    self,
                    "wovenfit_result_doubles",
                    (Handle, i32, *mut f64, usize, *mut usize, *mut Handle) -> i32,
                    result,
                    what,
                    buffer,
                    capacity,
                    count,
                    error
                )
            })
            .expect("an array");
        };
        let mut count = 0;
        get(null_mut(), 0, &raw mut count);
        let mut values = vec![0.0; count];
        get(values.as_mut_ptr(), count, &raw mut count);
        values
    }

    /// Indices of a result.
    pub fn indices(&self, result: Handle, what: i32) -> Vec<u32> {
        let get = |buffer: *mut u32, capacity: usize, count: *mut usize| {
            self.done(|error| {
                call!(
                    self,
                    "wovenfit_result_indices",
                    (Handle, i32, *mut u32, usize, *mut usize, *mut Handle) -> i32,
                    result,
                    what,
                    buffer,
                    capacity,
                    count,
                    error
                )
            })
            .expect("an array");
        };
        let mut count = 0;
        get(null_mut(), 0, &raw mut count);
        let mut values = vec![0; count];
        get(values.as_mut_ptr(), count, &raw mut count);
        values
    }

    /// Frees an object by the name of its function.
    pub fn free(&self, name: &str, handle: Handle) {
        // SAFETY: the signature of every function that frees.
        let free = unsafe { self.function::<unsafe extern "C" fn(Handle)>(name) };
        // SAFETY: each test frees what it got once.
        unsafe { free(handle) };
    }

    /// A pattern from a mesh and a design, in one step; what it was made from is freed.
    pub fn pattern(&self, mesh: &Mesh, design: &str, values: &[(&str, &str)]) -> Handle {
        let mesh = self.mesh(mesh, 1.0);
        let design = self.design(design).expect("a design");
        let parameters = self.parameters(values);
        let result = self.flatten(mesh, design, parameters).expect("a result");
        self.free("wovenfit_mesh_free", mesh);
        self.free("wovenfit_design_free", design);
        self.free("wovenfit_parameters_free", parameters);
        result
    }

    /// The version's text.
    pub fn version(&self) -> String {
        let version = call!(self, "wovenfit_version", () -> *const c_char,);
        assert!(!version.is_null());
        // SAFETY: a static text with its NUL.
        unsafe { std::ffi::CStr::from_ptr(version) }.to_str().expect("UTF-8").to_owned()
    }
}
