#nullable enable
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Editor
{
    /// <summary>Where one stylus of the open scenes plays, by the rules of the player (<see cref="SceneOutputs"/>):
    /// on an audio output, through the outputs that play it in a hand, or through the device that is chosen
    /// automatically.</summary>
    internal sealed class StylusPlaces
    {
        private readonly List<DeviceOutput> switchedOff = new List<DeviceOutput>();
        private readonly List<DeviceOutput> devices = new List<DeviceOutput>();

        private StylusPlaces(HapticStylus stylus, SceneContents scene)
        {
            Stylus = stylus;
            Hand = HandOf(stylus);
            foreach (DeviceOutput output in scene.AllDeviceOutputs.Where(each => each.Played == stylus))
            {
                (output.isActiveAndEnabled ? devices : switchedOff).Add(output);
            }
            IsNamed = stylus.Output != null;
            if (IsNamed)
            {
                Audio = stylus.Output!.isActiveAndEnabled ? stylus.Output : null;
                return;
            }
            HapticOutput? scenes = SceneOutputs.Preferred(scene.Outputs);
            HapticOutput? takes = scenes != null ? scenes : SceneOutputs.Preferred(scene.SwitchedOffOutputs);
            Audio = scenes;
            UsesHand = Hand != HapticHand.None && devices.Count + switchedOff.Count == 0 &&
                (takes == null || !takes.HasOwnChannel);
            GetsMadeOutput = takes == null && devices.Count + switchedOff.Count == 0;
        }

        public HapticStylus Stylus { get; }
        public HapticHand Hand { get; }
        public bool IsNamed { get; }

        /// <summary>The enabled audio output; null without one.</summary>
        public HapticOutput? Audio { get; }

        /// <summary>The enabled outputs that play the stylus in a hand.</summary>
        public IReadOnlyList<DeviceOutput> Devices => devices;

        /// <summary>Outputs in a hand that are switched off; they still prevent an automatic choice.</summary>
        public IReadOnlyList<DeviceOutput> SwitchedOff => switchedOff;

        /// <summary>True where the device in the hand is chosen automatically. The audio output then plays until one is
        /// connected.</summary>
        public bool UsesHand { get; }

        /// <summary>True where play mode adds an audio output; with <see cref="UsesHand"/>, until a device is
        /// connected.</summary>
        public bool GetsMadeOutput { get; }

        public bool IsSilent => Audio == null && devices.Count == 0 && !UsesHand && !GetsMadeOutput;

        public static IReadOnlyList<StylusPlaces> Of(SceneContents scene) =>
            scene.Styluses.Select(stylus => new StylusPlaces(stylus, scene)).ToArray();

        /// <summary>What plays each stylus, one line each; empty without a stylus.</summary>
        public static string Summary(SceneContents scene) =>
            string.Join("\n", Of(scene).Select(places => places.Sentence()));

        /// <summary>The name of an audio output, and where it plays, as messages show them.</summary>
        public static string NameOf(HapticOutput output)
        {
            string where = output.Route == OutputRoute.MixerEffect ? "in an Audio Mixer"
                : output.Channel < 0 ? "all channels of the audio device"
                : $"channel {output.Channel} of the audio device";
            return $"{output.name} ({where}{(output.Muted ? ", muted" : "")})";
        }

        /// <summary>The kind of an output in a hand, and the object that it is on, as messages show them.</summary>
        public static string NameOf(DeviceOutput output) =>
            $"{UnityEditor.ObjectNames.NicifyVariableName(output.GetType().Name)} on {PlaceOf(output)}";

        /// <summary>The hand in which an output plays; None without one.</summary>
        public static HapticHand HandOf(DeviceOutput output)
        {
            HapticStylus? played = output.Played;
            return output.Hand != HapticHand.None || played == null ? output.Hand : HandOf(played);
        }

        /// <summary>The hand that holds a stylus. An XR Pen sets it only when it wakes.</summary>
        public static HapticHand HandOf(HapticStylus stylus)
        {
            XrPen pen = stylus.GetComponentInParent<XrPen>(true);
            return pen == null || pen.Stylus != stylus ? stylus.Hand
                : pen.Hand == PenHand.Left ? HapticHand.Left : HapticHand.Right;
        }

        private string Sentence()
        {
            string name = Stylus.PenName;
            if (UsesHand)
            {
                string until = Audio != null ? $"plays on {NameOf(Audio)}"
                    : GetsMadeOutput ? "plays on all channels of the audio device" : "is silent";
                return $"{name} is felt through the device in the {Hand.InWords()} hand; until one is connected it {until}.";
            }
            IEnumerable<string> places = devices.Select(InHand);
            if (Audio != null)
            {
                places = places.Append(NameOf(Audio));
            }
            else if (GetsMadeOutput)
            {
                places = places.Append("all channels of the audio device, by an output that play mode adds");
            }
            return IsSilent ? $"{name} is silent." : $"{name} plays on {string.Join(", and on ", places)}.";
        }

        private static string InHand(DeviceOutput output)
        {
            HapticHand hand = HandOf(output);
            string where = hand == HapticHand.None ? "in no hand" : $"{hand.InWords()} hand";
            return $"{NameOf(output)} ({where}{(output.Muted ? ", muted" : "")})";
        }

        private static string PlaceOf(DeviceOutput output) =>
            output.TryGetComponent(out HapticStylus stylus) ? stylus.PenName : output.name;
    }
}
