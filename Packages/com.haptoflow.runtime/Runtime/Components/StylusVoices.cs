#nullable enable
using System;
using HaptoFlow.Contact;

namespace HaptoFlow
{
    /// <summary>The voices of one stylus: one on an audio output, and one on each device output that references the
    /// stylus. Each output drives the clock of its own voice. Main thread; no garbage while nothing changes.</summary>
    internal sealed class StylusVoices
    {
        private readonly HapticStylus stylus;
        private readonly StylusVoice audio;
        private Device[] devices = Array.Empty<Device>();
        private int named;

        public StylusVoices(HapticStylus stylus)
        {
            this.stylus = stylus;
            audio = new StylusVoice(stylus);
        }

        /// <summary>True where the scene's author assigned a device output to the stylus, enabled or not: none is then
        /// chosen automatically.</summary>
        public bool HasNamedDevices => named > 0;

        /// <summary>The output chosen automatically for this stylus; null where it was not requested.</summary>
        public AutoOutput? Chosen { get; set; }

        /// <summary>The audio output of which the console said that it plays the stylus instead of the device in its
        /// hand; null before.</summary>
        public HapticOutput? LeftOutFor { get; set; }

        /// <summary>Counts a device output that the author assigned to the stylus, or no longer assigns.</summary>
        public void Name(bool names) => named += names ? 1 : -1;

        /// <summary>Adds an output that plays the stylus.</summary>
        public void Add(IVoiceTarget target)
        {
            if (!Array.Exists(devices, each => ReferenceEquals(each.Target, target)))
            {
                Array.Resize(ref devices, devices.Length + 1);
                devices[devices.Length - 1] = new Device(target, new StylusVoice(stylus));
            }
        }

        /// <summary>Removes an output that no longer plays the stylus.</summary>
        public void Remove(IVoiceTarget target)
        {
            Device[] before = devices;
            devices = Array.FindAll(before, each => !ReferenceEquals(each.Target, target));
            foreach (Device each in before)
            {
                if (ReferenceEquals(each.Target, target))
                {
                    each.Voice.Close();
                }
            }
        }

        /// <summary>Statistics of the audio output's voice; without one, of the first device's.</summary>
        public bool TryGetStatistics(out VoiceStatistics statistics)
        {
            if (audio.TryGetStatistics(out statistics))
            {
                return true;
            }
            foreach (Device each in devices)
            {
                if (each.Voice.TryGetStatistics(out statistics))
                {
                    return true;
                }
            }
            return false;
        }

        /// <summary>Statistics of the audio output's voice, else of the first device's.</summary>
        public bool TryGetEffectStatistics(HapticEffect effect, out EffectStatistics statistics)
        {
            if (audio.TryGetEffectStatistics(effect, out statistics))
            {
                return true;
            }
            foreach (Device each in devices)
            {
                if (each.Voice.TryGetEffectStatistics(effect, out statistics))
                {
                    return true;
                }
            }
            return false;
        }

        /// <summary>Statistics of the audio output's voice, which alone plays signals.</summary>
        public bool TryGetSignalStatistics(out SignalStatistics statistics) =>
            audio.TryGetSignalStatistics(out statistics);

        public void Panic()
        {
            audio.Panic();
            foreach (Device each in devices)
            {
                each.Voice.Panic();
            }
        }

        public void Publish(in ContactReading reading, in ResolvedMaterial felt, HapticSession session)
        {
            audio.Publish(reading, felt, session, WantedAudio());
            foreach (Device each in devices)
            {
                each.Voice.Publish(reading, felt, session, each.Target);
            }
        }

        public void Close()
        {
            audio.Close();
            foreach (Device each in devices)
            {
                each.Voice.Close();
            }
        }

        /// <summary>Null for silence: a disabled output is not replaced by another.</summary>
        private HapticOutput? WantedAudio()
        {
            HapticOutput? chosen = stylus.Output;
            if (chosen == null)
            {
                return SceneOutputs.For(stylus);
            }
            AutoOutput.Retire(stylus);
            return chosen.isActiveAndEnabled ? chosen : null;
        }

        private readonly struct Device
        {
            public Device(IVoiceTarget target, StylusVoice voice)
            {
                Target = target;
                Voice = voice;
            }

            public IVoiceTarget Target { get; }

            public StylusVoice Voice { get; }
        }
    }
}
