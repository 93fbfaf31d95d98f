//! Which of a machine's adapters does the work.

use std::str::FromStr;

use thiserror::Error;

use super::GpuError;
use geometry::names::shown;

/// What is requested.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum AdapterChoice {
    /// The one that the system thinks the fastest.
    #[default]
    Best,
    /// One that runs on the CPU.
    Software,
    /// The first with this in its name, in capitals or not; as it was typed.
    Named(String),
}

/// Nothing was requested.
#[derive(Debug, PartialEq, Eq, Error)]
#[error("it has no name: give part of one that `pnaen adapters` lists, or software")]
pub struct NoName;

impl FromStr for AdapterChoice {
    type Err = NoName;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text.trim() {
            "" => Err(NoName),
            name if name.eq_ignore_ascii_case("software") => Ok(Self::Software),
            name => Ok(Self::Named(name.to_owned())),
        }
    }
}

impl AdapterChoice {
    fn takes(&self, info: &wgpu::AdapterInfo) -> bool {
        match self {
            Self::Best => true,
            Self::Software => info.device_type == wgpu::DeviceType::Cpu,
            Self::Named(name) => info.name.to_lowercase().contains(&name.to_lowercase()),
        }
    }

    /// The first of these that was requested and is able to do something: to show a window, say.
    ///
    /// # Errors
    /// There is none such, none that is able, or none at all.
    pub fn among_able<'a>(
        &self,
        adapters: &'a [wgpu::Adapter],
        is_able: impl Fn(&wgpu::Adapter) -> bool,
    ) -> Result<&'a wgpu::Adapter, GpuError> {
        let infos: Vec<_> = adapters.iter().map(wgpu::Adapter::get_info).collect();
        let able: Vec<_> = adapters.iter().map(is_able).collect();
        self.place_able(&infos, &able).map(|place| &adapters[place])
    }

    fn place_able(&self, infos: &[wgpu::AdapterInfo], able: &[bool]) -> Result<usize, GpuError> {
        let first = self.place(infos)?;
        let mut all = infos.iter().zip(able);
        let place = all.position(|(info, &is_able)| is_able && self.takes(info));
        place.ok_or_else(|| GpuError::NoWindow { name: infos[first].name.clone() })
    }

    fn place(&self, infos: &[wgpu::AdapterInfo]) -> Result<usize, GpuError> {
        if let Some(place) = infos.iter().position(|info| self.takes(info)) {
            return Ok(place);
        }
        let has = infos.iter().map(|info| info.name.as_str()).collect::<Vec<_>>().join(", ");
        Err(match self {
            _ if infos.is_empty() => GpuError::NoAdapter,
            Self::Software => GpuError::NoSoftwareAdapter { has },
            Self::Best => GpuError::NoAdapter,
            Self::Named(name) => GpuError::NoSuchAdapter { name: shown(name), has },
        })
    }
}

/// What adapters are looked for by. OpenGL shows no texture in another format than it has, which pictures need.
pub const BACKENDS: wgpu::Backends = wgpu::Backends::PRIMARY;

fn instance() -> wgpu::Instance {
    let descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    // Line numbers of shaders take a software driver's compiler a tenth of its time. WGPU_DEBUG=1 has them.
    let flags = descriptor.flags.difference(wgpu::InstanceFlags::DEBUG).with_env();
    wgpu::Instance::new(wgpu::InstanceDescriptor { backends: BACKENDS, flags, ..descriptor })
}

/// The machine's fastest, as the system has it.
///
/// # Errors
/// There is none.
pub fn best_adapter() -> Result<wgpu::Adapter, GpuError> {
    let instance = instance();
    let options =
        wgpu::RequestAdapterOptions { power_preference: wgpu::PowerPreference::HighPerformance, ..Default::default() };
    pollster::block_on(instance.request_adapter(&options)).map_err(|_| GpuError::NoAdapter)
}

/// All adapters that there are, graphics cards first and software last.
pub fn adapters() -> Vec<wgpu::Adapter> {
    let instance = instance();
    let mut all = pollster::block_on(instance.enumerate_adapters(BACKENDS));
    all.sort_by_key(|adapter| match adapter.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    });
    all
}

/// What an adapter is, in words.
pub fn kind(device_type: wgpu::DeviceType) -> &'static str {
    match device_type {
        wgpu::DeviceType::DiscreteGpu => "graphics card",
        wgpu::DeviceType::IntegratedGpu => "integrated",
        wgpu::DeviceType::VirtualGpu => "virtual",
        wgpu::DeviceType::Cpu => "software",
        wgpu::DeviceType::Other => "of unknown kind",
    }
}

/// The name and the version of an adapter's driver, as far as it tells them.
pub fn driver(info: &wgpu::AdapterInfo) -> String {
    [info.driver.as_str(), info.driver_info.as_str()].join(" ").trim().to_owned()
}

/// All that a picture's px depend on besides the program and the command: the adapter's name, which for Mesa's software driver
/// has the vector width, its driver and, if it runs on the CPU, the processor. Processors approximate reciprocal square roots
/// in different ways, and software drivers turn light into colours with these. None if part of it is unknown, such as the
/// driver on Metal.
pub fn identity(info: &wgpu::AdapterInfo) -> Option<String> {
    let (name, driver) = (&info.name, driver(info));
    match info.device_type {
        _ if driver.is_empty() => None,
        wgpu::DeviceType::Cpu => Some(format!("{name}, {driver}, on {}", processor()?)),
        _ => Some(format!("{name}, {driver}")),
    }
}

#[cfg(target_os = "linux")]
fn processor() -> Option<String> {
    processor_in(&std::fs::read_to_string("/proc/cpuinfo").ok()?)
}

/// The first processor in the system's list.
#[cfg(target_os = "linux")]
fn processor_in(list: &str) -> Option<String> {
    let value = |key: &str| {
        let mut pairs = list.lines().filter_map(|line| line.split_once(':'));
        pairs.find(|(own, _)| own.trim() == key).map(|(_, value)| value.trim())
    };
    Some(format!("{} (family {}, model {})", value("model name")?, value("cpu family")?, value("model")?))
}

#[cfg(not(target_os = "linux"))]
fn processor() -> Option<String> {
    // Windows has it.
    std::env::var("PROCESSOR_IDENTIFIER").ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_drew_a_picture_is_known_by_adapter_driver_and_processor() {
        let of = |name: &str, device_type, driver: &str, driver_info: &str| {
            let (driver, driver_info) = (driver.to_owned(), driver_info.to_owned());
            identity(&wgpu::AdapterInfo { driver, driver_info, ..info(name, device_type) })
        };
        let card = of("NVIDIA H200", wgpu::DeviceType::DiscreteGpu, "NVIDIA", "580.159.04");
        assert_eq!(card.as_deref(), Some("NVIDIA H200, NVIDIA 580.159.04"));
        assert_eq!(of("Apple M1", wgpu::DeviceType::IntegratedGpu, "", ""), None, "Metal names no driver");
        #[cfg(target_os = "linux")]
        {
            let list = "processor\t: 0\ncpu family\t: 25\nmodel\t\t: 17\nmodel name\t: AMD EPYC\n\nmodel\t\t: 1\n";
            assert_eq!(processor_in(list).as_deref(), Some("AMD EPYC (family 25, model 17)"));
            assert_eq!(processor_in("processor\t: 0\nFeatures\t: fp asimd\n"), None);
            let name = "llvmpipe (LLVM 15.0.6, 256 bits)";
            let software = of(name, wgpu::DeviceType::Cpu, "llvmpipe", "Mesa 22.3.6");
            let expected = processor().map(|processor| format!("{name}, llvmpipe Mesa 22.3.6, on {processor}"));
            assert_eq!(software, expected);
        }
    }

    fn info(name: &str, device_type: wgpu::DeviceType) -> wgpu::AdapterInfo {
        wgpu::AdapterInfo { name: name.to_owned(), ..wgpu::AdapterInfo::new(device_type, wgpu::Backend::Vulkan) }
    }

    fn place(choice: &str, infos: &[wgpu::AdapterInfo]) -> Result<usize, String> {
        let choice: AdapterChoice = choice.parse().map_err(|error: NoName| error.to_string())?;
        choice.place(infos).map_err(|error| error.to_string())
    }

    #[test]
    fn adapters_are_chosen_by_part_of_their_name_or_as_software() {
        let infos = [info("GeForce RTX 4090", wgpu::DeviceType::DiscreteGpu), info("llvmpipe", wgpu::DeviceType::Cpu)];
        assert_eq!(AdapterChoice::Best.place(&infos).ok(), Some(0));
        assert_eq!(place("rtx", &infos), Ok(0));
        assert_eq!(place("LLVMpipe", &infos), Ok(1));
        assert_eq!(place("software", &infos), Ok(1));
        assert_eq!(place("SOFTware", &infos), Ok(1));
        assert!(place(" ", &infos).is_err_and(|error| error.starts_with("it has no name")));
    }

    #[test]
    fn what_shows_no_window_is_told_from_what_is_not_there() {
        let two = ["GeForce RTX 4090", "GeForce GT 710"].map(|name| info(name, wgpu::DeviceType::DiscreteGpu));
        let place = |choice: &str, able: [bool; 2]| {
            let choice: AdapterChoice = choice.parse().map_err(|error: NoName| error.to_string())?;
            choice.place_able(&two, &able).map_err(|error| error.to_string())
        };
        assert_eq!(place("geforce", [true, true]), Ok(0));
        assert_eq!(place("geforce", [false, true]), Ok(1), "the first that is able");
        let expected = "the adapter GeForce RTX 4090 can't show a window on this display: choose another (pnaen adapters), or \
                        use the commands (pnaen --help)";
        assert_eq!(place("rtx", [false, true]), Err(expected.to_owned()));
        assert!(place("radeon", [true, true]).is_err_and(|error| error.contains("has \"radeon\" in its name")));
    }

    #[test]
    fn what_is_not_there_is_refused_with_what_is() {
        let infos = [info("GeForce RTX 4090", wgpu::DeviceType::DiscreteGpu)];
        let expected = "no graphics adapter has \"Radeon\" in its name: there are GeForce RTX 4090 (pnaen adapters)";
        assert_eq!(place("Radeon", &infos), Err(expected.to_owned()));
        assert!(place("software", &infos).is_err_and(|error| error.contains("mesa-vulkan-drivers")));
        assert!(place("software", &[]).is_err_and(|error| error.contains("no graphics adapter was found")));
    }
}
