//! Writes files that are whole or not there.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file that is removed unless it was brought to its place.
struct Part(PathBuf);

impl Drop for Part {
    fn drop(&mut self) {
        // It is gone already where it was brought to its place.
        fs::remove_file(&self.0).ok();
    }
}

/// Writes a file. Whenever it is interrupted, the path has the old file, or none, or the new one: the bytes go to a
/// file beside it, which takes its place when it is complete.
///
/// # Errors
///
/// Those of the file system. The file beside it is removed then.
pub fn save(path: &Path, bytes: &[u8]) -> io::Result<()> {
    save_by(path, |file| file.write_all(bytes))
}

fn save_by(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    let name = path.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "no name of a file"))?;
    let mut beside = std::ffi::OsString::from(".");
    beside.push(name);
    beside.push(format!(".{}.part", std::process::id()));
    let part = Part(path.with_file_name(beside));
    // A process of this number that was killed may have left one.
    fs::remove_file(&part.0).ok();
    let mut file = File::create_new(&part.0)?;
    write(&mut file)?;
    file.sync_all()?;
    drop(file);
    fs::rename(&part.0, path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interrupted_write_leaves_the_old_file_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("model.zstm");
        let cut = |file: &mut File| {
            file.write_all(b"half of")?;
            Err(io::Error::other("the disk is full"))
        };
        save_by(&path, cut).expect_err("a full disk");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
        save(&path, b"old").expect("a file");
        save_by(&path, cut).expect_err("a full disk");
        assert_eq!(fs::read(&path).expect("a file"), b"old");
        // Half of the new file is never at the path.
        save_by(&path, |file| {
            file.write_all(b"new")?;
            assert_eq!(fs::read(&path).expect("a file"), b"old");
            Ok(())
        })
        .expect("a file");
        assert_eq!(fs::read(&path).expect("a file"), b"new");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
    }
}
