#nullable enable
using System;
using System.Collections.Generic;
using System.Threading.Tasks;
using HaptoFlow.Model;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The learnt materials of one engine. Each is registered once, on another thread, when a surface that
    /// uses it is enabled or first touched. Until then, and where the engine refuses it, its label is used. Main
    /// thread; no garbage while nothing changes.</summary>
    internal sealed class LearntMaterials
    {
        private readonly HapticEngine engine;
        private readonly string space;
        private readonly Dictionary<HapticMaterial, Known> known = new Dictionary<HapticMaterial, Known>();
        private readonly double[] stiffness = new double[HapticEngine.MaximumMaterials];
        private readonly Stack<int> free = new Stack<int>();
        private readonly List<Known> waiting = new List<Known>();
        private readonly int labelCount;
        private Task<List<MaterialRegistration>>? running;
        private int taken;

        /// <param name="labelCount">Number of labels of the engine's model: indices of materials follow those of
        /// labels.</param>
        public LearntMaterials(HapticEngine engine, string space, int labelCount) =>
            (this.engine, this.space, this.labelCount) = (engine, space, labelCount);

        public int Felt { get; private set; }

        public int Refused { get; private set; }

        /// <summary>Finds a material's index in the engine; requests its registration where there is none.</summary>
        /// <param name="isWaiting">True while the registration is under way.</param>
        public bool TryFind(HapticMaterial material, out int index, out bool isWaiting)
        {
            if (!known.TryGetValue(material, out Known found))
            {
                found = new Known(material);
                known.Add(material, found);
                Ask(found);
            }
            index = found.Index;
            isWaiting = found.IsUnderWay || waiting.Contains(found);
            return index >= 0;
        }

        /// <summary>Why the engine refused a material; null where it did not, or the material was not
        /// requested.</summary>
        public string? WhyRefused(HapticMaterial material) =>
            known.TryGetValue(material, out Known found) && found.IsRefused ? found.Refusal : null;

        public double StiffnessNewtonsPerMetre(int index) => stiffness[index - labelCount];

        /// <summary>Registers the new text of a material. A material that was never requested is left alone.</summary>
        public void Change(HapticMaterial material)
        {
            if (known.TryGetValue(material, out Known found) && !ReferenceEquals(found.Text, material.Learnt))
            {
                Ask(found);
            }
        }

        /// <summary>Removes a material that was destroyed or lost its text; its index becomes free.</summary>
        /// <returns>True where the material was known.</returns>
        public bool Forget(HapticMaterial material)
        {
            if (!known.TryGetValue(material, out Known found))
            {
                return false;
            }
            known.Remove(material);
            waiting.Remove(found);
            SetRefused(found, false);
            found.IsGone = true;
            if (!found.IsUnderWay)
            {
                Release(found);
                StartNext();
            }
            return true;
        }

        /// <summary>Takes over completed registrations. Call once a frame.</summary>
        /// <returns>True where an index may have changed.</returns>
        public bool Poll()
        {
            if (running == null || !running.IsCompleted)
            {
                return false;
            }
            List<MaterialRegistration> done = running.GetAwaiter().GetResult();
            running = null;
            foreach (MaterialRegistration each in done)
            {
                TakeOver((Known)each.Owner, each);
            }
            StartNext();
            return true;
        }

        public void Finish()
        {
            while (running != null)
            {
                ((IAsyncResult)running).AsyncWaitHandle.WaitOne();
                Poll();
            }
        }

        /// <summary>Waits for the registration under way and starts no other: the engine must stay open
        /// meanwhile.</summary>
        public void Close()
        {
            waiting.Clear();
            Finish();
        }

        private void Ask(Known material)
        {
            if (!waiting.Contains(material))
            {
                waiting.Add(material);
            }
            StartNext();
        }

        private void StartNext()
        {
            if (running != null || waiting.Count == 0)
            {
                return;
            }
            var next = new List<MaterialRegistration>();
            var withoutPlace = new List<Known>();
            foreach (Known each in waiting)
            {
                each.Text = each.Material.Learnt;
                if (each.Index < 0 && free.Count == 0 && taken == HapticEngine.MaximumMaterials)
                {
                    Refuse(each, $"{HapticEngine.MaximumMaterials} learnt materials are in use, which is the most " +
                        "that an engine takes. It gets a place when another one is unloaded.");
                    withoutPlace.Add(each);
                    continue;
                }
                int place = each.Index >= 0 ? each.Index : free.Count > 0 ? free.Pop() : MaterialRegistration.NewPlace;
                taken += place == MaterialRegistration.NewPlace ? 1 : 0;
                each.IsUnderWay = true;
                next.Add(new MaterialRegistration(each, each.Text, place));
            }
            waiting.Clear();
            waiting.AddRange(withoutPlace);
            if (next.Count > 0)
            {
                running = Task.Run(() => next.ConvertAll(each => each.Do(engine, space)));
            }
        }

        private void TakeOver(Known material, MaterialRegistration done)
        {
            material.IsUnderWay = false;
            bool wasFelt = material.Index >= 0;
            // Where the engine refused a new text it still holds the old one, which is released below.
            material.Index = done.Place;
            taken -= done.Place == MaterialRegistration.NewPlace ? 1 : 0;
            Felt += wasFelt || material.Index < 0 ? 0 : 1;
            if (done.Refusal != null || material.IsGone)
            {
                Release(material);
            }
            else
            {
                stiffness[material.Index - labelCount] = done.StiffnessNewtonsPerMetre;
                SetRefused(material, false);
            }
            if (done.Refusal != null && !material.IsGone)
            {
                Refuse(material, done.Refusal);
            }
        }

        private void Release(Known material)
        {
            if (material.Index >= 0)
            {
                free.Push(material.Index);
                material.Index = -1;
                --Felt;
            }
        }

        private void Refuse(Known material, string why)
        {
            if (material.IsRefused && material.Refusal == why)
            {
                return;
            }
            SetRefused(material, true);
            material.Refusal = why;
            HapticMaterial asset = material.Material;
            string label = asset.Description.Label;
            Debug.LogWarning($"HaptoFlow: {asset.name} is felt as its label \"{label}\": {why}", asset);
        }

        private void SetRefused(Known material, bool isRefused)
        {
            Refused += isRefused == material.IsRefused ? 0 : isRefused ? 1 : -1;
            material.IsRefused = isRefused;
        }

        private sealed class Known
        {
            public readonly HapticMaterial Material;

            // Requested last.
            public string Text = "";

            // In the engine; -1 where the material is not registered.
            public int Index = -1;
            public bool IsUnderWay;
            public bool IsRefused;
            public string Refusal = "";
            public bool IsGone;

            public Known(HapticMaterial material) => Material = material;
        }
    }

    /// <summary>The registration of one learnt material with an engine. Created on the main thread, run on
    /// another.</summary>
    /// <param name="Place">Index of the material to replace, or <see cref="NewPlace"/>; of a result, its index in the
    /// engine, or <see cref="NewPlace"/> where the engine refused a new one.</param>
    internal sealed record MaterialRegistration(object Owner, string Text, int Place,
        double StiffnessNewtonsPerMetre = 0.0, string? Refusal = null)
    {
        /// <summary>The engine assigns the index.</summary>
        public const int NewPlace = -1;

        public static string ForeignSpace(string own, string models) =>
            $"it was learnt for another model (its space is {own}, the model's {models}). Learn it again from its " +
            "recording with this model, or choose the model that it was learnt for in Project Settings > HaptoFlow.";

        public MaterialRegistration Do(HapticEngine engine, string space)
        {
            try
            {
                MaterialFile file = MaterialFile.Read(Text);
                if (file.Space != space)
                {
                    return this with { Refusal = ForeignSpace(file.Space, space) };
                }
                int place = Place;
                if (place == NewPlace)
                {
                    place = engine.RegisterMaterial(Text);
                }
                else
                {
                    engine.ReplaceMaterial(place, Text);
                }
                return this with { Place = place, StiffnessNewtonsPerMetre = file.StiffnessNewtonsPerMetre };
            }
            catch (HaptoFlowException refusal)
            {
                return this with { Refusal = refusal.Message + "." };
            }
        }
    }
}
