//! Files under temporary names, complete, on their way to their own names.
//!
//! A temporary file goes when nothing came of it, be it that its value is dropped or that the process is told to end by a
//! signal. What a killed process leaves does not block the next one: a name that is taken is left alone.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The temporary files of this process. Who holds it is not ended by a signal that can be caught.
static LIVE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Temporary names that are tried for one file.
const NAMES: u32 = 100;

type Live = MutexGuard<'static, BTreeSet<PathBuf>>;

fn live() -> Live {
    LIVE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file of the file system with a temporary name; it goes with this value.
#[derive(Debug)]
struct Temporary(PathBuf);

impl Temporary {
    /// Makes a name beside `target` (or in `folder`) by `make`, which must not replace a file.
    fn new<T>(
        target: &Path,
        folder: Option<&Path>,
        make: impl Fn(&Path) -> io::Result<T>,
    ) -> io::Result<(Self, T)> {
        signals::watch();
        let mut live = live();
        for count in 0..NAMES {
            let name = temporary_name(target, folder, count)?;
            match make(&name) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
                Ok(made) => {
                    live.insert(name.clone());
                    return Ok((Temporary(name), made));
                }
            }
        }
        Err(io::Error::new(io::ErrorKind::AlreadyExists, "old temporary files are in the way"))
    }

    /// Gives it a name of its own.
    fn rename(self, target: &Path, live: &mut Live) -> Result<(), (Self, io::Error)> {
        match fs::rename(&self.0, target) {
            Ok(()) => {
                self.forget(live);
                Ok(())
            }
            Err(error) => Err((self, error)),
        }
    }

    /// Removes the file.
    fn remove(self, live: &mut Live) {
        // Nothing can be done about a temporary file that will not go away.
        let _ = fs::remove_file(&self.0);
        self.forget(live);
    }

    fn forget(mut self, live: &mut Live) {
        live.remove(&self.0);
        self.0 = PathBuf::new();
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.0.as_os_str().is_empty() {
            let _ = fs::remove_file(&self.0);
            live().remove(&self.0);
        }
    }
}

/// A complete file under a temporary name; no temporary name for devices and pipes, which are written at once.
#[derive(Debug)]
pub struct Staged {
    target: PathBuf,
    temporary: Option<Temporary>,
}

/// Where a temporary file is made.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Beside {
    Target,
    /// In the nearest directory above the target that is there: the target's own may be made later.
    NearestFolder,
}

/// Writes a file under a temporary name.
pub fn stage(path: &Path, bytes: &[u8], beside: Beside) -> io::Result<Staged> {
    let old = fs::metadata(path).ok();
    if old.as_ref().is_some_and(fs::Metadata::is_dir) {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a directory"));
    }
    if old.as_ref().is_some_and(|m| !m.is_file()) {
        File::options().write(true).open(path)?.write_all(bytes)?;
        return Ok(Staged { target: path.to_path_buf(), temporary: None });
    }
    // A link is kept: what it points to is replaced.
    let target = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    // Above a relative path's first directory is the working directory.
    let here = |f: &&Path| f.as_os_str().is_empty() || f.is_dir();
    let nearest = target.ancestors().skip(1).find(here).filter(|_| beside == Beside::NearestFolder);
    let create = |name: &Path| File::options().write(true).create_new(true).open(name);
    let (temporary, mut file) = Temporary::new(&target, nearest, create)?;
    file.write_all(bytes)?;
    if let Some(old) = old {
        file.set_permissions(old.permissions())?;
    }
    Ok(Staged { target, temporary: Some(temporary) })
}

/// `.NAME.PID.tmp`, and another one for every count from 1.
fn temporary_name(target: &Path, folder: Option<&Path>, count: u32) -> io::Result<PathBuf> {
    let name = target
        .file_name()
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "it has no file name"))?;
    let process = std::process::id();
    let end = if count == 0 { format!(".{process}.tmp") } else { format!(".{process}.{count}.tmp") };
    let mut hidden = OsString::from(".");
    hidden.push(shortened(name, end.len()));
    hidden.push(end);
    Ok(folder.map_or_else(|| target.with_file_name(&hidden), |folder| folder.join(&hidden)))
}

/// A name with room for so many more bytes in what file systems take as one name.
fn shortened(name: &std::ffi::OsStr, more: usize) -> OsString {
    const LONGEST: usize = 250;
    if name.len() + more <= LONGEST {
        return name.to_owned();
    }
    let text = name.to_string_lossy();
    let room = LONGEST.saturating_sub(more);
    let ends = text.char_indices().map(|(at, c)| at + c.len_utf8());
    let end = ends.take_while(|end| *end <= room).last().unwrap_or(0);
    text.get(..end).unwrap_or_default().into()
}

/// Gives all files their names, or none; the error is that of the file with this name.
pub fn commit(staged: Vec<Staged>) -> Result<(), (PathBuf, io::Error)> {
    let several = staged.len() > 1;
    let kept: Result<Vec<Kept>, _> = staged.into_iter().map(|file| Kept::of(file, several)).collect();
    let mut done: Vec<Kept> = Vec::new();
    let mut rest = kept?.into_iter();
    // No signal ends the process between the first rename and the last.
    let mut live = live();
    let failed = loop {
        let Some(mut next) = rest.next() else { break None };
        let Some(temporary) = next.temporary.take() else { continue };
        match temporary.rename(&next.target, &mut live) {
            Ok(()) => done.push(next),
            Err((temporary, error)) => {
                temporary.remove(&mut live);
                break Some((next, error));
            }
        }
    };
    let Some((at_fault, error)) = failed else {
        done.into_iter().filter_map(|kept| kept.old).for_each(|old| old.remove(&mut live));
        return Ok(());
    };
    done.into_iter().rev().for_each(|kept| kept.undo(&mut live));
    drop(live);
    Err((at_fault.target.clone(), error))
}

/// A file that is to get its name, and what has that name now.
struct Kept {
    target: PathBuf,
    temporary: Option<Temporary>,
    /// A second name of the old file.
    old: Option<Temporary>,
}

impl Kept {
    /// With others, there may be a way back to go.
    fn of(staged: Staged, others: bool) -> Result<Kept, (PathBuf, io::Error)> {
        let Staged { target, temporary } = staged;
        let failed = |error| (target.clone(), error);
        // The directory may still be missing; one that is would leave some files renamed and some not.
        if let Some(folder) = target.parent().filter(|p| !p.as_os_str().is_empty()) {
            fs::metadata(folder).map_err(failed)?;
        }
        let replaces =
            others && temporary.is_some() && fs::symlink_metadata(&target).is_ok_and(|old| old.is_file());
        let old = if replaces { Some(second_name(&target).map_err(failed)?) } else { None };
        Ok(Kept { target, temporary, old })
    }

    /// What was there before is there again.
    fn undo(self, live: &mut Live) {
        match self.old {
            Some(old) => {
                if let Err((old, _)) = old.rename(&self.target, live) {
                    // It is not lost: it keeps its second name.
                    old.forget(live);
                }
            }
            None => {
                let _ = fs::remove_file(&self.target);
            }
        }
    }
}

/// Another name for a file, or a copy where the file system knows no second names.
fn second_name(target: &Path) -> io::Result<Temporary> {
    let make = |name: &Path| match fs::hard_link(target, name) {
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => copy(target, name),
        linked => linked,
    };
    Temporary::new(target, None, make).map(|(temporary, ())| temporary)
}

fn copy(from: &Path, to: &Path) -> io::Result<()> {
    let mut new = File::options().write(true).create_new(true).open(to)?;
    let copied = File::open(from).and_then(|mut old| io::copy(&mut old, &mut new));
    if copied.is_err() {
        let _ = fs::remove_file(to);
    }
    copied.map(|_| ())
}

#[cfg(unix)]
mod signals {
    //! What ends the process from outside removes its temporary files first.

    use std::fs;
    use std::sync::Once;

    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    /// Watches from the first call on. Where it cannot be done, signals end the process as ever.
    pub fn watch() {
        static ONCE: Once = Once::new();
        ONCE.call_once(|| {
            let wanted = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|s| !ignored(*s));
            if let Ok(mut signals) = Signals::new(wanted) {
                std::thread::spawn(move || signals.forever().for_each(end));
            }
        });
    }

    fn end(signal: i32) {
        let live = super::live();
        for file in live.iter() {
            let _ = fs::remove_file(file);
        }
        let _ = emulate_default_handler(signal);
    }

    /// Whether the process was started to ignore a signal (`nohup`, jobs in the background), where the system tells.
    fn ignored(signal: i32) -> bool {
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let mask = mask.and_then(|m| u64::from_str_radix(m.trim(), 16).ok()).unwrap_or(0);
        let bit = u32::try_from(signal - 1).ok().and_then(|shift| 1_u64.checked_shl(shift)).unwrap_or(0);
        mask & bit != 0
    }
}

#[cfg(not(unix))]
mod signals {
    /// Other systems end a process without a word.
    pub fn watch() {}
}

#[cfg(test)]
mod tests {
    use super::{Beside, commit, stage, temporary_name};
    use std::fs;
    use std::path::{Path, PathBuf};

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("partwright-temporary-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("a directory");
        folder
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("a directory").filter_map(Result::ok);
        let mut names: Vec<String> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    fn write(path: &Path, text: &str) {
        commit(vec![stage(path, text.as_bytes(), Beside::Target).expect("staged")]).expect("written");
    }

    #[test]
    fn when_one_file_cannot_get_its_name_those_before_it_are_as_they_were() {
        let folder = folder("undo");
        write(&folder.join("a"), "old");
        let all = ["a", "b", "c", "d"].map(|name| folder.join(name));
        let staged = all.iter().map(|path| stage(path, b"new", Beside::Target).expect("staged")).collect();
        // Somebody makes a directory of that name meanwhile.
        fs::create_dir_all(folder.join("c/x")).expect("a directory");
        let (path, _) = commit(staged).expect_err("a directory is in the way");
        assert_eq!(path, folder.join("c"));
        assert_eq!(names(&folder), ["a", "c"]);
        assert_eq!(fs::read_to_string(folder.join("a")).expect("a file"), "old");
        fs::remove_dir_all(&folder).expect("removed");
    }

    #[test]
    fn what_a_killed_process_left_blocks_nothing() {
        let folder = folder("stale");
        let target = folder.join("a");
        let stale = temporary_name(&target, None, 0).expect("a name");
        write(&stale, "left by a process of the same number");
        write(&target, "new");
        write(&target, "newer");
        assert_eq!(fs::read_to_string(&target).expect("a file"), "newer");
        assert_eq!(names(&folder).len(), 2, "{:?}", names(&folder));
        assert!(stale.exists());
        fs::remove_dir_all(&folder).expect("removed");
    }

    #[test]
    fn names_as_long_as_they_may_be_can_be_written() {
        let folder = folder("long");
        let names_of_old = ["x".repeat(255), "ü".repeat(127)];
        for name in &names_of_old {
            write(&folder.join(name), "old");
            write(&folder.join(name), "new");
        }
        assert_eq!(names(&folder), names_of_old);
        fs::remove_dir_all(&folder).expect("removed");
    }
}
