#nullable enable
using System;
using HaptoFlow.Contact;

namespace HaptoFlow
{
    /// <summary>The voices of one stylus: one on an audio output, one on each device output that names the stylus. Each
    /// output drives its own voice's clock. Main thread; no garbage while nothing changes.</summary>
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

        /// <summary>An author gave the stylus a device output, switched on or off: then none is chosen for it.</summary>
        public bool HasNamedDevices => named > 0;

        /// <summary>The output that was chosen for this stylus, or will be; null where nobody asked.</summary>
        public AutoOutput? Chosen { get; set; }

        /// <summary>An author's output names the stylus, or does so no more.</summary>
        public void Name(bool names) => named += names ? 1 : -1;

        /// <summary>The output wants to play what the stylus feels.</summary>
        public void Add(IVoiceTarget target)
        {
            if (!Array.Exists(devices, each => ReferenceEquals(each.Target, target)))
            {
                Array.Resize(ref devices, devices.Length + 1);
                devices[devices.Length - 1] = new Device(target, new StylusVoice(stylus));
            }
        }

        /// <summary>The output plays no more.</summary>
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

        /// <summary>Of the audio output's voice; where there is none, of the first device's.</summary>
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

        /// <summary>Of the audio output's voice, else of the first that there is.</summary>
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

        /// <summary>Of the audio output's voice, which alone has a signal.</summary>
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

        public void Publish(in ContactReading reading, in FeltMaterial felt, HapticSession session)
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

        /// <summary>Null for silence: an output that is switched off is not replaced by another.</summary>
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
