//! Firmware is built, and runs in QEMU.

use super::failure::Failure;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// An emulated core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Core {
    /// Name on the command line and in the tables.
    pub name: &'static str,
    triple: &'static str,
    program: &'static str,
    /// Debian's package of the program.
    package: &'static str,
    machine: &'static [&'static str],
    /// The shift of `-icount`: a shift of 3 makes an instruction take 8 ns, so SysTick at 25 MHz ticks once in five.
    shift: u32,
    instructions_per_tick: u64,
    /// Address of the words.
    words_at: &'static str,
    /// The core's number for the counting plugin.
    plugin_core: Option<u32>,
}

/// The cores that firmware is counted on.
pub const CORES: [Core; 3] = [
    Core {
        name: "m0+",
        triple: "thumbv6m-none-eabi",
        program: "qemu-system-arm",
        package: "qemu-system-arm",
        machine: &["-machine", "mps2-an385"],
        shift: 3,
        instructions_per_tick: 5,
        words_at: "0x21000000",
        plugin_core: Some(0),
    },
    Core {
        name: "m4",
        triple: "thumbv7em-none-eabihf",
        program: "qemu-system-arm",
        package: "qemu-system-arm",
        machine: &["-machine", "mps2-an386"],
        shift: 3,
        instructions_per_tick: 5,
        words_at: "0x21000000",
        plugin_core: Some(4),
    },
    Core {
        name: "rv32imc",
        triple: "riscv32imc-unknown-none-elf",
        program: "qemu-system-riscv32",
        package: "qemu-system-misc",
        machine: &["-bios", "none", "-machine", "virt"],
        shift: 0,
        instructions_per_tick: 1,
        words_at: "0x81000000",
        plugin_core: None,
    },
];

/// A stage of a frame, as the firmware counted it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counted {
    pub stage: String,
    /// The number of the show.
    pub show: usize,
    /// The number of the frame.
    pub number: u32,
    pub instructions: u64,
    pub hash: u32,
}

/// A copy of zstrip, whose example `container` is the firmware.
pub struct Firmware {
    root: PathBuf,
    /// The folder of what is built.
    pub target: PathBuf,
}

impl Firmware {
    /// Looks whether a folder is a copy of zstrip.
    pub fn of(root: &Path) -> Result<Self, Failure> {
        let source = root.join("examples/container.rs");
        if !source.is_file() {
            return Err(Failure::Failed(format!(
                "{} is not there, which is the firmware: --zstrip DIR names a copy of zstrip",
                source.display()
            )));
        }
        Ok(Self { root: root.to_owned(), target: root.join("target") })
    }

    /// Builds the firmware for a core, and returns its file.
    pub fn build(&self, core: &Core) -> Result<PathBuf, Failure> {
        let mut cargo = Command::new("cargo");
        cargo.current_dir(&self.root).args(["rustc", "-q", "--release", "--example", "container", "--target"]);
        cargo.arg(core.triple).arg("--target-dir").arg(&self.target).env("CARGO_PROFILE_RELEASE_DEBUG", "0");
        let output = cargo.stdin(Stdio::null()).output();
        let output = output.map_err(|error| Failure::Failed(format!("cargo does not run: {error}")))?;
        if !output.status.success() {
            let error = String::from_utf8_lossy(&output.stderr).into_owned();
            let missing = error.contains("can't find crate for `core`");
            let hint = if missing { format!("\nrustup target add {} adds it", core.triple) } else { String::new() };
            return Err(Failure::Failed(format!("the firmware for {} was not built:\n{error}{hint}", core.name)));
        }
        Ok(self.target.join(core.triple).join("release/examples/container"))
    }
}

/// Runs firmware with words in its memory, and returns what it counted. `plugin` counts to the instruction; else
/// SysTick counts to within five.
pub fn run(
    core: &Core,
    image: &Path,
    words: &Path,
    plugin: Option<&Path>,
    limit: Duration,
) -> Result<Vec<Counted>, Failure> {
    let failed = |error: String| Failure::Failed(format!("{}: {error}", core.name));
    let [printed, complaints, counts] =
        ["txt", "err", "count"].map(|ending| words.with_extension(format!("{}.{ending}", core.name)));
    let create = |path: &Path| fs::File::create(path).map_err(|error| failed(format!("{}: {error}", path.display())));
    let mut qemu = Command::new(core.program);
    qemu.args(core.machine).args(["-nographic", "-monitor", "none"]);
    qemu.args(["-semihosting-config", "enable=on,target=native"]);
    qemu.args(["-icount", &format!("shift={},sleep=off,align=off", core.shift)]);
    qemu.arg("-device").arg(joined(&[
        "loader,file=".as_ref(),
        words.as_ref(),
        ",force-raw=on,addr=".as_ref(),
        core.words_at.as_ref(),
    ]));
    let plugin = plugin.zip(core.plugin_core);
    if let Some((plugin, number)) = plugin {
        let core = format!(",core={number}");
        qemu.arg("-plugin").arg(joined(&[plugin.as_ref(), ",out=".as_ref(), counts.as_ref(), core.as_ref()]));
    }
    qemu.arg("-kernel").arg(image).stdin(Stdio::null());
    qemu.stdout(create(&printed)?).stderr(create(&complaints)?);
    let mut child = qemu.spawn().map_err(|error| {
        failed(format!("{} does not run: {error}; Debian's package is {}", core.program, core.package))
    })?;
    let begin = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().map_err(|error| failed(error.to_string()))? {
            break status;
        }
        if begin.elapsed() > limit {
            // It may have ended just now.
            _ = child.kill();
            _ = child.wait();
            return Err(failed(format!(
                "QEMU has not ended after {} s; --limit SECONDS gives it more",
                limit.as_secs()
            )));
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    let read = |path: &Path| fs::read_to_string(path).map_err(|error| failed(format!("{}: {error}", path.display())));
    let text = read(&printed)?;
    if !status.success() {
        let last = text.lines().last().filter(|line| parse(line).is_none()).unwrap_or_default();
        return Err(failed(format!("QEMU ended with {status}: {last} {}", read(&complaints)?.trim())));
    }
    let lines = text.lines().map(|line| parse(line).ok_or_else(|| failed(format!("the firmware printed: {line}"))));
    let mut counted = lines.collect::<Result<Vec<_>, _>>()?;
    if plugin.is_some() {
        let exact = read(&counts)?;
        let exact: Vec<_> = exact.lines().filter_map(instructions).collect();
        if exact.len() < counted.len() {
            return Err(failed(format!("the plugin counted {} stages of {}", exact.len(), counted.len())));
        }
        counted.iter_mut().zip(exact).for_each(|(counted, exact)| counted.instructions = exact);
    } else {
        counted.iter_mut().for_each(|counted| counted.instructions *= core.instructions_per_tick);
    }
    Ok(counted)
}

/// Reads a line of the firmware; instructions are ticks still.
fn parse(line: &str) -> Option<Counted> {
    let mut words = line.split(' ');
    let (stage, run) = (words.next()?.to_owned(), words.next()?);
    let (show, number) = run.split_once('.')?;
    let (show, number) = (show.parse().ok()?, number.parse().ok()?);
    let instructions = words.next()?.parse().ok()?;
    let hash = u32::from_str_radix(words.next()?, 16).ok()?;
    Some(Counted { stage, show, number, instructions, hash })
}

/// Reads a line of the plugin: `REGION number insns=n cycles=c`.
fn instructions(line: &str) -> Option<u64> {
    let mut words = line.strip_prefix("REGION ")?.split_whitespace();
    words.nth(1)?.split_once('=')?.1.parse().ok()
}

/// Returns an argument of QEMU, in which a comma of a path is two.
fn joined(parts: &[&std::ffi::OsStr]) -> OsString {
    let mut all = OsString::new();
    for (k, part) in parts.iter().enumerate() {
        match part.to_str() {
            // Parts that begin with a comma, and the first one, are options.
            Some(path) if k > 0 && !path.starts_with(',') => all.push(path.replace(',', ",,")),
            _ => all.push(part),
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_firmware_and_plugin_are_read() {
        let counted = Counted { stage: "draw".to_owned(), show: 2, number: 7, instructions: 123, hash: 0x811C_9DC5 };
        assert_eq!(parse("draw 2.7 123 811c9dc5 10 20 30"), Some(counted));
        assert_eq!(parse("error: the container is wrong"), None);
        assert_eq!(instructions("REGION 0 insns=1234 cycles=2000"), Some(1234));
        assert_eq!(instructions("TOTAL 0 insns=1234"), None);
    }

    #[test]
    fn commas_of_paths_are_written_twice() {
        let found = joined(&["loader,file=".as_ref(), "a,b/c.bin".as_ref(), ",addr=".as_ref()]);
        assert_eq!(found, "loader,file=a,,b/c.bin,addr=");
    }
}
